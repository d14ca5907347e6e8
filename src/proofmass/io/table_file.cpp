#include "proofmass/io/table_file.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <tuple>

#include "proofmass/io/csv/header.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/reading/channel_units.hpp"

namespace proofmass::io {
namespace {

/// "Acc_X (g)", or the name alone if no unit is known.
std::string heading_of(const std::string& name, const Unit& unit) {
  return unit.symbol.empty() ? name : name + " (" + unit.symbol + ")";
}

class OnlyTable final : public TableFile {
 public:
  explicit OnlyTable(std::unique_ptr<RecordingReader> reader) : reader_(std::move(reader)) {
    const RawHead& head = reader_->head();
    if (head.stamps) summary_.headings.push_back(heading_of(head.stamps->name, head.stamps->unit));
    for (const Channel& channel : head.recording.channels)
      summary_.headings.push_back(heading_of(channel.name, channel.unit));
    summary_.rows = head.rows;
    summary_.rate_hz = head.rate_hz;
  }

  [[nodiscard]] std::span<const TableSummary> tables() const override { return {&summary_, 1}; }
  [[nodiscard]] Result<std::unique_ptr<RecordingReader>> open(std::size_t,
                                                              const ReadOptions&) override {
    if (!reader_) return Error{Errc::unreadable, "can be read once only"};
    return std::move(reader_);
  }

 private:
  std::unique_ptr<RecordingReader> reader_;
  TableSummary summary_;
};

/// Suitability of a table: 2 accelerations including gravity, 1 without gravity, 0 none.
int likeness_to_accelerations(const TableSummary& table) {
  bool any = false;
  for (const std::string& heading : table.headings) {
    const ColumnLabel label = read_label(heading);
    const bool is_other =
        label.unit.quantity != Quantity::acceleration && label.unit.quantity != Quantity::unknown &&
        label.unit.quantity != Quantity::voltage && label.unit.quantity != Quantity::counts;
    if (is_other) continue;
    const bool is_meant =
        label.unit.quantity == Quantity::acceleration || is_accelerometer_name(label.name);
    const std::string bare = bare_name(label.name + " " + table.name);
    // Gravity removed by a phone or an attitude filter.
    const bool without_gravity =
        bare.find("linear") != std::string::npos || bare.find("freeacc") != std::string::npos ||
        bare.find("earth") != std::string::npos || bare.find("gravity") != std::string::npos ||
        bare.find("useracc") != std::string::npos || bare.find("withoutg") != std::string::npos;
    if (is_meant && !without_gravity) return 2;
    any = any || is_meant;
  }
  return any ? 1 : 0;
}

std::string described(const TableSummary& table) {
  const std::size_t columns = table.headings.size();
  std::string text = fmt::format("{} ({} column{}", table.name, columns, columns == 1 ? "" : "s");
  if (table.rows && !table.rows_are_guessed) text += fmt::format(", {} rows", *table.rows);
  return text + ")";
}

/// Match of a table's name with the requested one: 3 exact, 2 except for case, 1 by the end of its
/// path, 0 none.
int fit_of(const std::string& name, const std::string& wanted) {
  if (name == wanted) return 3;
  const std::string small = lower(name);
  const std::string small_wanted = lower(wanted);
  if (small == small_wanted) return 2;
  const bool is_end =
      !small_wanted.empty() && small.ends_with(small_wanted) &&
      (small[small.size() - small_wanted.size() - 1] == '/' || small_wanted.front() == '/');
  return is_end ? 1 : 0;
}

std::string names_of(std::span<const TableSummary> tables) {
  std::string names;
  for (const TableSummary& table : tables) {
    if (names.size() > 200) return names + ", …";
    names += (names.empty() ? "" : ", ") + table.name;
  }
  return names;
}

/// The tables that match a name best.
Result<std::vector<std::size_t>> tables_called(std::span<const TableSummary> tables,
                                               const std::string& wanted) {
  int best = 1;
  std::vector<std::size_t> found;
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const int fit = fit_of(tables[t].name, wanted);
    if (fit > best) found.clear();
    best = std::max(best, fit);
    if (fit == best) found.push_back(t);
  }
  if (found.empty())
    return Error{Errc::invalid_argument,
                 fmt::format("has no table {}; it has {}", wanted, names_of(tables))};
  return found;
}

/// The measured table of accelerations, of several the one with most rows, else the first with most
/// rows.
std::size_t likeliest(std::span<const TableSummary> tables) {
  const auto rank = [&](std::size_t t) {
    return std::tuple(!tables[t].is_derived, likeness_to_accelerations(tables[t]),
                      tables[t].rows.value_or(0));
  };
  std::size_t best = 0;
  for (std::size_t t = 1; t < tables.size(); ++t)
    if (rank(t) > rank(best)) best = t;
  return best;
}

void note_the_others(std::span<const TableSummary> tables,
                     std::size_t chosen,
                     std::vector<Note>& notes) {
  if (tables.size() < 2) return;
  constexpr std::size_t most_listed = 8;
  std::string others;
  std::string example;
  std::size_t listed = 0;
  for (std::size_t t = 0; t < tables.size() && listed < most_listed; ++t) {
    if (t == chosen) continue;
    if (listed++ == 0) example = tables[t].name;
    others += (others.empty() ? "" : ", ") + described(tables[t]);
  }
  if (tables.size() > most_listed + 1)
    others += fmt::format(" and {} more", tables.size() - most_listed - 1);
  const int likeness = likeness_to_accelerations(tables[chosen]);
  // The user may have meant another table with accelerations.
  bool is_open = false;
  for (std::size_t t = 0; t < tables.size(); ++t)
    is_open = is_open || (t != chosen && likeness == 2 && !tables[t].is_derived &&
                          likeness_to_accelerations(tables[t]) == likeness);
  notes.push_back({is_open ? Severity::warning : Severity::info,
                   fmt::format("{} is read{}; also holds {}", tables[chosen].name,
                               likeness > 0 ? ", having accelerations" : "", others),
                   {Advice{"variable", example}}});
}

}  // namespace

std::unique_ptr<TableFile> only_table(std::unique_ptr<RecordingReader> reader) {
  return std::make_unique<OnlyTable>(std::move(reader));
}

Result<std::vector<std::size_t>> choose_table(std::span<const TableSummary> tables,
                                              const ReadOptions& options,
                                              std::vector<Note>& notes) {
  if (tables.empty()) return Error{Errc::too_few_samples, "holds no table of figures"};
  if (options.variables.empty()) {
    const std::size_t chosen = likeliest(tables);
    note_the_others(tables, chosen, notes);
    return std::vector{chosen};
  }
  std::vector<std::size_t> chosen;
  for (const std::string& name : options.variables) {
    const auto found = tables_called(tables, name);
    if (!found) return found.error();
    for (const std::size_t t : *found)
      if (std::ranges::find(chosen, t) == chosen.end()) chosen.push_back(t);
  }
  return chosen;
}

}  // namespace proofmass::io
