#include "proofmass/io/numpy/npy_reader.hpp"

#include <fmt/format.h>
#include <utility>

#include "proofmass/io/numpy/npy_figures.hpp"
#include "proofmass/io/numpy/npy_layout.hpp"
#include "proofmass/io/table_reader.hpp"

namespace proofmass::io {
namespace {

class NpyTable final : public TableReader {
 public:
  explicit NpyTable(NpyFigures figures) : figures_(std::move(figures)) {
    const NpyLayout& layout = figures_.layout();
    head_.format = "npy";
    head_.columns = layout.columns.size();
    head_.rows = figures_.rows_there();
    for (const NpyColumn& column : layout.columns)
      if (layout.is_structured) head_.headings.push_back(column.name);
    if (layout.is_turned)
      head_.notes.push_back({Severity::info, "the array is channels x samples: turned"});
  }

  [[nodiscard]] const TableHead& head() const override { return head_; }
  [[nodiscard]] Result<std::size_t> read(std::span<const std::span<double>> into) override {
    return figures_.read(into);
  }
  [[nodiscard]] std::vector<Note> notes() const override { return figures_.notes(); }
  [[nodiscard]] double fraction_read() const override {
    return static_cast<double>(figures_.rows_read()) / static_cast<double>(figures_.layout().rows);
  }

 private:
  NpyFigures figures_;
  TableHead head_;
};

/// True if so few rows of so many columns are channels × samples.
bool is_lying(const std::vector<std::size_t>& shape) {
  constexpr std::size_t most_channels_in_rows = 64;
  return shape.size() == 2 && shape[0] <= most_channels_in_rows && shape[1] > 4 * shape[0];
}

}  // namespace

bool claims_npy(std::string_view head, std::string_view) {
  return head.starts_with("\x93NUMPY");
}

Result<std::unique_ptr<TableFile>> open_npy(std::unique_ptr<PeekSource> source,
                                            const ReadOptions& options) {
  const auto preface = peek_npy_preface(*source);
  if (!preface) return preface.error();
  const NpyHeader& header = preface->header;
  if (!header.is_structured && (header.shape.empty() || header.shape.size() > 2))
    return Error{Errc::unsupported,
                 fmt::format("holds an array of {} dimensions: expected samples x channels",
                             header.shape.size())};
  auto layout = npy_layout(*preface, !header.is_structured && is_lying(header.shape));
  if (!layout) return layout.error();
  auto bytes = random_bytes_of(std::move(source), options.progress);
  if (!bytes) return bytes.error();
  auto figures = NpyFigures::open(std::move(bytes).value(), std::move(layout).value());
  if (!figures) return figures.error();
  auto reader =
      recording_reader_of(std::make_unique<NpyTable>(std::move(figures).value()), options);
  if (!reader) return reader.error();
  return only_table(std::move(reader).value());
}

}  // namespace proofmass::io
