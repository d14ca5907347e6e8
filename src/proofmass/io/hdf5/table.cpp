#include "proofmass/io/hdf5/table.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <span>
#include <string>
#include <utility>

#include "proofmass/io/column_names.hpp"
#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/hdf5/choice.hpp"
#include "proofmass/io/hdf5/labels.hpp"
#include "proofmass/io/hdf5/stream.hpp"
#include "proofmass/io/matlab/mat_headings.hpp"

namespace proofmass::io::hdf5 {
namespace {

/// Source of a column of the table.
struct Destination {
  std::size_t request = 0;
  std::size_t column = 0;
};

class DatasetReader final : public TableReader {
 public:
  DatasetReader(FigureStream stream, TableHead head, std::vector<Destination> places)
      : stream_(std::move(stream)), head_(std::move(head)), places_(std::move(places)) {}

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] double fraction_read() const override { return stream_.fraction_read(); }

  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    const std::size_t wanted = into.front().size();
    std::size_t had = 0;
    while (had < wanted) {
      if (row_ == stream_.rows()) {
        const auto rows = stream_.next();
        if (!rows) return rows.error();
        row_ = 0;
        if (*rows == 0) break;
      }
      const std::size_t count = std::min(wanted - had, stream_.rows() - row_);
      for (std::size_t c = 0; c < places_.size(); ++c)
        stream_.copy(places_[c].request, places_[c].column, row_, into[c].subspan(had, count));
      had += count;
      row_ += count;
    }
    return had;
  }

 private:
  FigureStream stream_;
  TableHead head_;
  std::vector<Destination> places_;
  std::size_t row_ = 0;  ///< in the stream's block
};

/// The datasets to be read, and what is known of them before the first value.
struct Plan {
  std::vector<matlab::Table> tables;
  TableHead head;
};

Result<Plan> plan_plain(const OpenFile& file, const ReadOptions& options) {
  const auto choice = choose_datasets(file.catalogue, file.arrays, options);
  if (!choice) return choice.error();
  Plan plan{choice->tables, {}};
  plan.head.format = "HDF5";
  plan.head.notes = choice->notes;
  std::ranges::copy(file.notes, std::back_inserter(plan.head.notes));
  plan.head.rate_hz = rate_hz_of(file.catalogue, plan.tables, plan.head.notes);
  if (plan.head.rate_hz)
    plan.head.start_ns = start_ns_of(file.catalogue, plan.tables.front().array->path);
  return plan;
}

/// A variable of MATLAB is selected and named as in the older versions of its files.
Result<Plan> plan_matlab(const OpenFile& file, const ReadOptions& options) {
  matlab::Catalogue variables;
  variables.version = "MAT v7.3";
  variables.arrays = file.arrays;
  variables.skipped = file.catalogue.skipped;
  variables.is_cut = file.catalogue.is_cut;
  const auto choice = matlab::choose_tables(variables, options);
  if (!choice) return choice.error();
  const auto number_of = [&](const matlab::Array* array) {
    return static_cast<std::size_t>(array - variables.arrays.data());
  };
  Plan plan{choice->tables, {}};
  for (matlab::Table& table : plan.tables) table.array = &file.arrays[number_of(table.array)];
  plan.head.format = "MAT v7.3";
  plan.head.notes = choice->notes;
  std::ranges::copy(file.notes, std::back_inserter(plan.head.notes));
  if (choice->rate == nullptr) return plan;
  const auto figure = file.catalogue.datasets[number_of(choice->rate)].figure;
  const bool can_be = figure && matlab::is_rate(*figure);
  plan.head.notes.push_back(
      {Severity::info, fmt::format("{}: {}", choice->rate->path,
                                   can_be ? "the rate in Hz" : "is not a possible rate")});
  if (can_be) plan.head.rate_hz = figure;
  return plan;
}

Figures figures_of(const Dataset& dataset, const matlab::Table& table) {
  if (table.width > 1 || dataset.is_complex) return Figures::doubles;
  if (dataset.type == "int64") return Figures::int64;
  return dataset.type == "uint64" ? Figures::uint64 : Figures::doubles;
}

const Dataset& dataset_of(const OpenFile& file, const matlab::Table& table) {
  return file.catalogue.datasets[static_cast<std::size_t>(table.array - file.arrays.data())];
}

std::vector<Request> requests_of(const OpenFile& file, std::span<const matlab::Table> tables) {
  std::vector<Request> requests;
  for (const matlab::Table& table : tables) {
    const Dataset& dataset = dataset_of(file, table);
    requests.push_back({.name = table.array->path,
                        .address = dataset.address,
                        .rows = table.rows,
                        .width = table.width,
                        .is_by_row = table.is_turned,
                        .figures = figures_of(dataset, table)});
  }
  return requests;
}

/// The first column of each table, as far as it is in the first block.
std::vector<std::vector<std::vector<double>>> beginnings(const FigureStream& stream) {
  std::vector<std::vector<std::vector<double>>> values;
  for (std::size_t i = 0; i < stream.requests().size(); ++i) {
    std::vector<double> column(stream.rows());
    stream.copy(i, 0, 0, column);
    values.push_back({std::move(column)});
  }
  return values;
}

void put_headings(const OpenFile& file,
                  const FigureStream& stream,
                  const ReadOptions& options,
                  Plan& plan) {
  if (file.is_matlab) {
    plan.head.headings = headings_of(plan.tables, beginnings(stream), options);
    return;
  }
  std::vector<std::string> vectors;
  for (const matlab::Table& table : plan.tables)
    if (table.width == 1) vectors.push_back(table.name());
  const bool is_timed = plan.head.rate_hz || time_among(vectors, options);
  plan.head.headings =
      headings_of(file.catalogue, plan.tables, beginnings(stream), is_timed, plan.head.notes);
  note_texts(file.catalogue, plan.tables, plan.head.notes);
}

/// Integer stamps keep all digits, and stamps with a start in an attribute get that as their
/// origin.
void declare_stamps(const OpenFile& file,
                    std::span<const Destination> places,
                    const ReadOptions& options,
                    FigureStream& stream,
                    Plan& plan) {
  const auto time = time_among(plan.head.headings, options);
  if (!time) return;
  const std::size_t request = places[*time].request;
  const Unit unit = read_label(plan.head.headings[*time]).unit;
  if (stream.requests()[request].figures != Figures::doubles) {
    plan.head.stamps = {*time, unit, {stream.put_origin_at_first(request), 0}};
    return;
  }
  const std::string& path = plan.tables[request].array->path;
  for (const Attribute& attribute : file.catalogue.attributes)
    if (attribute.owner == path && attribute.name == "start_time_ns" && attribute.integer &&
        unit.symbol == "s")
      plan.head.stamps = {*time, unit, {*attribute.integer, -9}};
}

}  // namespace

Result<std::unique_ptr<TableReader>> open_table(const OpenFile& file, const ReadOptions& options) {
  auto planned = file.is_matlab ? plan_matlab(file, options) : plan_plain(file, options);
  if (!planned) return planned.error();
  Plan plan = std::move(planned).value();
  auto started = FigureStream::start(file.file, requests_of(file, plan.tables));
  if (!started) return started.error();
  FigureStream stream = std::move(started).value();
  if (const auto rows = stream.next(); !rows) return rows.error();
  put_headings(file, stream, options, plan);
  std::vector<Destination> places;
  for (std::size_t i = 0; i < plan.tables.size(); ++i)
    for (std::size_t c = 0; c < plan.tables[i].width; ++c) places.push_back({i, c});
  declare_stamps(file, places, options, stream, plan);
  plan.head.columns = places.size();
  plan.head.rows = plan.tables.front().rows;
  return std::unique_ptr<TableReader>(
      std::make_unique<DatasetReader>(std::move(stream), std::move(plan.head), std::move(places)));
}

}  // namespace proofmass::io::hdf5
