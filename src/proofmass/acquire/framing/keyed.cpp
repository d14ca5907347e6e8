#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

#include "proofmass/acquire/framing/dialect.hpp"
#include "proofmass/acquire/framing/keys.hpp"
#include "proofmass/io/shown_text.hpp"

namespace proofmass::acquire {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

class Keyed final : public LineDialect {
 public:
  explicit Keyed(std::vector<RowField> fields)
      : fields_(std::move(fields)), wanted_(fields_.size(), true), wanted_count_(fields_.size()) {}

  const std::vector<RowField>& fields() const override { return fields_; }
  bool has_names() const override { return true; }
  void keep(const RowPlan& plan) override {
    wanted_.assign(fields_.size(), false);
    for (const RowPlan::Column& column : plan.columns) wanted_[column.field] = true;
    wanted_count_ = plan.columns.size();
  }

  LineFit read(std::string_view line,
               std::optional<std::size_t> clock,
               std::span<double> values,
               std::optional<Tick>& tick) override {
    std::ranges::fill(values, nan);
    tick.reset();
    std::size_t found = 0;
    const bool is_whole =
        visit_keys(line, [&](std::string_view key, double value, const std::optional<Tick>& exact) {
          const std::size_t field = field_called(key);
          if (field == fields_.size()) return;
          if (wanted_[field]) ++found;
          values[field] = value;
          if (field == clock) tick = exact;
        });
    if (!is_whole) return found > 0 ? LineFit::broken : LineFit::words;
    if (found < wanted_count_ && found > 0) note_lack();
    return found > 0 ? LineFit::row : LineFit::blank;
  }

 private:
  /// Most lines have their keys in the same order.
  std::size_t field_called(std::string_view key) {
    if (next_ >= fields_.size()) next_ = 0;
    if (fields_[next_].heading == key) return next_++;
    const auto found = std::ranges::find(fields_, key, &RowField::heading);
    if (found == fields_.end()) {
      new_keys_.add(fmt::format("{} came later than the first lines: not recorded", io::shown(key)),
                    notes_);
      return fields_.size();
    }
    const auto field = static_cast<std::size_t>(found - fields_.begin());
    next_ = field + 1;
    return field;
  }
  void note_lack() {
    if (std::exchange(noted_lack_, true)) return;
    notes_.push_back({Severity::info,
                      "not all lines have all columns: NaN where one is missing; columns= keeps "
                      "those that belong together"});
  }

  std::vector<RowField> fields_;
  std::vector<bool> wanted_;
  std::size_t wanted_count_;
  std::size_t next_ = 0;
  RepeatedNote new_keys_{"figures with a name that the first lines do not have"};
  bool noted_lack_ = false;
};

/// A key in the first lines.
struct SeenKey {
  std::string key{};
  std::size_t lines = 0;
  bool has_figure = false;
};

/// The keys of the first lines in order of appearance.
class KeyCensus {
 public:
  void add(std::string_view line) {
    const bool fits =
        visit_keys(line, [&](std::string_view key, double value, const std::optional<Tick>&) {
          auto place = places_.find(key);
          if (place == places_.end()) {
            if (seen_.size() == most_keys) return;
            place = places_.emplace(key, seen_.size()).first;
            seen_.push_back({std::string(key)});
          }
          SeenKey& seen = seen_[place->second];
          ++seen.lines;
          seen.has_figure = seen.has_figure || !std::isnan(value);
        });
    fitting_ += fits ? 1 : 0;
  }
  [[nodiscard]] std::size_t fitting() const { return fitting_; }
  /// A word with a colon on a single line is a message for people.
  [[nodiscard]] std::vector<SeenKey> repeated() const {
    constexpr std::size_t enough_to_tell = 8;
    std::vector<SeenKey> keys = seen_;
    if (fitting_ >= enough_to_tell) std::erase_if(keys, [](auto& key) { return key.lines < 2; });
    return keys;
  }

 private:
  static constexpr std::size_t most_keys = 1024;
  std::vector<SeenKey> seen_;
  std::map<std::string, std::size_t, std::less<>> places_;
  std::size_t fitting_ = 0;
};

}  // namespace

FoundDialect find_keyed(std::span<const HeldLine> lines, const FramingOptions& options) {
  const std::size_t begin = options.carrier == Carrier::stream && lines.size() > 1 ? 1 : 0;
  KeyCensus census;
  for (const HeldLine& line : lines.subspan(begin)) census.add(line.text);
  if (2 * census.fitting() <= lines.size() - begin) return {};
  const std::vector<SeenKey> keys = census.repeated();
  std::vector<io::ColumnLabel> labels;
  for (const SeenKey& seen : keys) labels.push_back(io::read_label(io::shown(seen.key)));
  std::vector<Note> notes;
  io::complete_names(labels, notes);
  std::vector<RowField> fields;
  for (std::size_t f = 0; f < labels.size(); ++f)
    fields.push_back(
        {.heading = keys[f].key, .label = labels[f], .is_figures = keys[f].has_figure});
  if (fields.empty()) return {};
  return {std::make_unique<Keyed>(std::move(fields)), begin, std::move(notes)};
}

}  // namespace proofmass::acquire
