#include "proofmass/io/hdf5/choice.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>
#include <utility>

#include "proofmass/io/column_names.hpp"
#include "proofmass/io/hdf5/path.hpp"
#include "proofmass/io/names.hpp"

namespace proofmass::io::hdf5 {
namespace {

/// A name as typed by the user: "/imu/acc/" is "imu/acc".
std::string_view bare_path(std::string_view name) {
  while (name.starts_with('/')) name.remove_prefix(1);
  while (name.ends_with('/')) name.remove_suffix(1);
  return name;
}

class Chooser {
 public:
  Chooser(const Catalogue& catalogue,
          const std::vector<matlab::Array>& arrays,
          const ReadOptions& options)
      : catalogue_(catalogue), arrays_(arrays), options_(options) {
    for (const matlab::Array& array : arrays)
      if (const auto table = table_in(array)) tables_.push_back(*table);
  }

  Status run() {
    if (options_.variables.empty()) {
      const Status taken = take_best("");
      if (taken && take_asked_for()) add_time();
      return taken;
    }
    for (const std::string& name : options_.variables)
      if (const Status taken = take_named(name); !taken) return taken;
    add_time();
    return Done{};
  }

  Result<Choice> choice() const {
    Choice choice;
    Result<std::vector<matlab::Table>> tables = matlab::chosen_tables(tables_, chosen_);
    if (!tables) return tables.error();
    choice.tables = std::move(tables).value();
    report(choice);
    return choice;
  }

 private:
  static constexpr std::size_t most_columns_joined = 512;

  /// Selects the datasets of the requested channels instead; false if there are none, or they are
  /// selected already.
  bool take_asked_for() {
    std::set<const matlab::Array*> asked = matlab::arrays_asked_for(tables_, options_);
    if (std::ranges::includes(chosen_, asked)) return false;
    chosen_ = std::move(asked);
    return true;
  }

  /// Selects the tables of the subgroup with the most values.
  Status take_best(std::string_view within) {
    struct Weight {
      bool may_be_samples = false;
      matlab::TableKind kind = matlab::TableKind::other;
      std::size_t figures = 0;
      auto operator<=>(const Weight&) const = default;
    };
    std::size_t longest = 0;
    for (const matlab::Table& table : tables_)
      if (is_within(table.array->path, within)) longest = std::max(longest, table.rows);
    std::map<std::pair<std::string_view, std::size_t>, Weight> weights;
    for (const matlab::Table& table : tables_) {
      if (!is_within(table.array->path, within)) continue;
      Weight& weight = weights[{table.array->group(), table.rows}];
      weight.may_be_samples = matlab::may_be_samples(table, longest);
      weight.figures += table.figures();
      weight.kind = std::max(weight.kind, matlab::kind_of(table));
    }
    const auto best =
        std::ranges::max_element(weights, {}, [](const auto& entry) { return entry.second; });
    if (best == weights.end()) return Error{Errc::too_few_samples, nothing_there()};
    const auto [group, rows] = best->first;
    take_around(group, rows);
    return Done{};
  }

  /// Rows of named fields are samples, however few.
  [[nodiscard]] std::optional<matlab::Table> table_in(const matlab::Array& array) const {
    if (!dataset_of(array).is_compound) return matlab::table_of(array);
    const matlab::Table table{&array, array.shape[1], array.shape[0], true};
    const bool is_table = table.rows > 1 && table.width > 0 && table.width <= matlab::most_channels;
    return is_table ? std::optional(table) : std::nullopt;
  }

  /// Adds the datasets of that length in a group, around it, and below it or the group that has its
  /// time.
  void take_around(std::string_view group, std::size_t rows) {
    const matlab::Table* time = time_in(group, rows);
    if (time != nullptr && dataset_of(*time->array).is_compound) {
      chosen_.insert(time->array);
      return;
    }
    std::string_view scope = group;
    for (std::string_view above = group;; above = group_of(above)) {
      if (has_time(above, rows)) {
        scope = above;
        break;
      }
      if (above.empty()) break;
    }
    std::size_t columns = 0;
    for (const matlab::Table& table : tables_) {
      const std::string_view own = table.array->group();
      const bool belongs =
          is_within(group, own) || (is_within(own, scope) && !has_time_below(scope, own, rows));
      if (table.rows != rows || !belongs) continue;
      columns += table.width;
      if (columns > most_columns_joined && !chosen_.empty()) break;
      chosen_.insert(table.array);
    }
  }

  /// True if a group has its own time, with this number of samples.
  [[nodiscard]] bool has_time(std::string_view group, std::size_t rows) const {
    return time_in(group, rows) != nullptr;
  }

  [[nodiscard]] const matlab::Table* time_in(std::string_view group, std::size_t rows) const {
    std::vector<const matlab::Table*> vectors;
    std::vector<std::string> names;
    for (const matlab::Table& table : tables_) {
      const bool is_there = table.rows == rows && table.array->group() == group;
      if (is_there && dataset_of(*table.array).is_compound && has_time_field(table)) return &table;
      if (is_there && table.width == 1) {
        vectors.push_back(&table);
        names.push_back(table.name());
      }
    }
    const auto time = time_among(names, options_);
    return time ? vectors[*time] : nullptr;
  }

  [[nodiscard]] bool has_time_field(const matlab::Table& table) const {
    const auto columns = std::ranges::find_if(catalogue_.attributes, [&](const auto& attribute) {
      return attribute.owner == table.array->path && attribute.name == "columns";
    });
    return columns != catalogue_.attributes.end() &&
           time_among(columns->texts, options_).has_value();
  }

  /// True if a group, or one between it and `scope`, has its own time.
  [[nodiscard]] bool has_time_below(std::string_view scope,
                                    std::string_view group,
                                    std::size_t rows) const {
    for (; group.size() > scope.size(); group = group_of(group))
      if (has_time(group, rows)) return true;
    return false;
  }

  [[nodiscard]] std::string nothing_there() const {
    const std::string there = others();
    if (there.empty()) return "holds no dataset";
    return fmt::format("holds no table of samples (numbers, at most {} channels): it has {}",
                       matlab::most_channels, there);
  }

  Status take_named(const std::string& name) {
    const std::string_view path = bare_path(name);
    const auto named = [&](const matlab::Array& array) { return array.path == path; };
    const auto alike = [&](const matlab::Array& array) { return lower(array.path) == lower(path); };
    auto array = std::ranges::find_if(arrays_, named);
    if (array == arrays_.end()) array = std::ranges::find_if(arrays_, alike);
    if (array != arrays_.end()) {
      chosen_.insert(&*array);
      if (table_in(*array)) return Done{};
      return Error{Errc::invalid_argument,
                   fmt::format("{} is not a table of samples, at most {} channels",
                               description(dataset_of(*array)), matlab::most_channels)};
    }
    if (!path.empty() && take_best(path)) return Done{};
    return Error{
        Errc::invalid_argument,
        fmt::format("has no dataset {} that is a table of samples; it has {}", path, others())};
  }

  /// Adds the time beside the named datasets, or in the nearest group around them.
  void add_time() {
    const auto first = std::ranges::find_if(
        tables_, [&](const matlab::Table& table) { return chosen_.contains(table.array); });
    for (std::string_view group = first->array->group();; group = group_of(group)) {
      const matlab::Table* time = time_in(group, first->rows);
      if (time != nullptr) chosen_.insert(time->array);
      if (time != nullptr || group.empty()) return;
    }
  }

  [[nodiscard]] const Dataset& dataset_of(const matlab::Array& array) const {
    return catalogue_.datasets[static_cast<std::size_t>(&array - arrays_.data())];
  }

  /// The contents of the file that were not selected, for the user.
  [[nodiscard]] std::string others() const {
    constexpr std::size_t most = 8;
    std::vector<std::string> items;
    for (const matlab::Array& array : arrays_)
      if (!chosen_.contains(&array) && !matlab::is_rate_name(matlab::Table{&array}.name()))
        items.push_back(description(dataset_of(array)));
    items.insert(items.end(), catalogue_.skipped.begin(), catalogue_.skipped.end());
    std::string text;
    for (std::size_t i = 0; i < std::min(items.size(), most); ++i)
      text += (i == 0 ? "" : ", ") + items[i];
    if (items.size() > most) text += fmt::format(" and {} more", items.size() - most);
    return text;
  }

  void report(Choice& choice) const {
    constexpr std::size_t most = 12;
    const auto add = [&](Severity severity, std::string text) {
      choice.notes.push_back({severity, std::move(text)});
    };
    std::string read;
    for (std::size_t i = 0; i < std::min(choice.tables.size(), most); ++i)
      read += (i == 0 ? "" : ", ") + description(dataset_of(*choice.tables[i].array));
    if (choice.tables.size() > most)
      read += fmt::format(" and {} more", choice.tables.size() - most);
    const std::string why =
        options_.variables.empty() && choice.tables.size() > 1
            ? fmt::format(": what has {} samples and lies together", choice.tables[0].rows)
            : "";
    add(Severity::info, fmt::format("HDF5: {} read{}", read, why));
    for (const matlab::Table& table : choice.tables)
      if (table.width > 1 && !table.is_turned)
        add(Severity::info, table.array->path + " is channels x samples: turned");
    for (const matlab::Table& table : choice.tables)
      if (table.array->is_complex)
        add(Severity::warning, table.array->path + " is complex: its real part is read");
    if (const std::string rest = others(); !rest.empty())
      choice.notes.push_back(
          {Severity::info, fmt::format("also in the file: {}", rest), {Advice{"dataset"}}});
    if (catalogue_.is_cut)
      add(Severity::warning, fmt::format("of the objects in the file only the first {} were "
                                         "looked at",
                                         most_objects));
  }

  const Catalogue& catalogue_;
  const std::vector<matlab::Array>& arrays_;
  const ReadOptions& options_;
  std::vector<matlab::Table> tables_;
  std::set<const matlab::Array*> chosen_;
};

}  // namespace

std::vector<matlab::Array> arrays_of(const Catalogue& catalogue) {
  std::vector<matlab::Array> arrays;
  arrays.reserve(catalogue.datasets.size());
  for (const Dataset& dataset : catalogue.datasets) {
    matlab::Array array;
    array.path = dataset.path;
    // A table of named fields is its own group: no dataset is beside its fields.
    array.group_length = dataset.is_compound ? dataset.path.size() : dataset.group_length;
    array.class_name = dataset.type;
    array.shape.assign(dataset.shape.rbegin(), dataset.shape.rend());
    while (array.shape.size() < 2) array.shape.insert(array.shape.begin(), 1);
    array.is_complex = dataset.is_complex;
    arrays.push_back(std::move(array));
  }
  return arrays;
}

std::string description(const Dataset& dataset) {
  std::string shape;
  for (const std::uint64_t length : dataset.shape) shape += fmt::format("{} x ", length);
  if (shape.empty()) return fmt::format("{} (a single {})", dataset.path, dataset.type);
  shape.erase(shape.size() - 3);
  return fmt::format("{} ({} {})", dataset.path, shape, dataset.type);
}

Result<Choice> choose_datasets(const Catalogue& catalogue,
                               const std::vector<matlab::Array>& arrays,
                               const ReadOptions& options) {
  Chooser chooser(catalogue, arrays, options);
  if (const Status done = chooser.run(); !done) return done.error();
  return chooser.choice();
}

}  // namespace proofmass::io::hdf5
