#include "proofmass/io/matlab/mat_choice.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <tuple>

#include "proofmass/io/arrays/recording.hpp"
#include "proofmass/io/names.hpp"
#include "proofmass/io/reading/channel_units.hpp"

namespace proofmass::io::matlab {
namespace {

std::size_t size_of(const Array& array) {
  std::size_t size = 1;
  for (const std::size_t length : array.shape) size *= length;
  return size;
}

/// Contents of the file for the user, largest first: "acc (500 x 3 double), title (text), …".
std::string contents(const Catalogue& catalogue, const std::set<const Array*>& but) {
  constexpr std::size_t most = 8;
  std::vector<const Array*> arrays;
  for (const Array& array : catalogue.arrays)
    if (!but.contains(&array)) arrays.push_back(&array);
  std::ranges::stable_sort(
      arrays, [](const Array* one, const Array* other) { return size_of(*one) > size_of(*other); });
  std::vector<std::string> items;
  items.reserve(arrays.size() + catalogue.skipped.size());
  for (const Array* array : arrays)
    items.push_back(fmt::format("{} ({})", array->path, array->description()));
  items.insert(items.end(), catalogue.skipped.begin(), catalogue.skipped.end());
  std::string text;
  for (std::size_t i = 0; i < std::min(items.size(), most); ++i)
    text += (i == 0 ? "" : ", ") + items[i];
  if (items.size() > most) text += fmt::format(" and {} more", items.size() - most);
  return text;
}

/// True if `path` is `group` or lies in it.
bool is_within(std::string_view path, std::string_view group) {
  if (group.empty() || path == group) return true;
  return path.starts_with(group) &&
         std::string_view(".({").find(path[group.size()]) != std::string_view::npos;
}

/// True if a channel has a table's name, optionally with the suffix of a column.
bool is_channel_of(const std::string& channel, const Table& table) {
  const std::string wanted = lower(channel);
  const auto is_of = [&](const std::string& name) {
    if (wanted == name) return true;
    return table.width > 1 && wanted.starts_with(name) &&
           (wanted[name.size()] == '_' || wanted[name.size()] == ' ');
  };
  return is_of(lower(table.name())) || is_of(lower(table.array->path));
}

class Chooser {
 public:
  Chooser(const Catalogue& catalogue, const ReadOptions& options)
      : catalogue_(catalogue), options_(options) {
    for (const Array& array : catalogue.arrays)
      if (const auto table = table_of(array)) tables_.push_back(*table);
  }

  Status run() {
    if (options_.variables.empty()) {
      const Status taken = take_largest("");
      return taken && take_asked_for() ? add_time() : taken;
    }
    for (const std::string& name : options_.variables)
      if (const Status taken = take_named(name); !taken) return taken;
    return add_time();
  }

  Result<Choice> choice() {
    Choice choice;
    Result<std::vector<Table>> tables = chosen_tables(tables_, chosen_);
    if (!tables) return tables.error();
    choice.tables = std::move(tables).value();
    choice.rate = rate_beside(choice.tables.front());
    choice.start = start_beside(choice.tables.front());
    report(choice);
    return choice;
  }

 private:
  /// Selects the tables of the requested channels instead; false if there are none, or they are
  /// selected already.
  bool take_asked_for() {
    std::set<const Array*> asked = arrays_asked_for(tables_, options_);
    if (std::ranges::includes(chosen_, asked)) return false;
    chosen_ = std::move(asked);
    return true;
  }

  /// The largest table within a group, preferring accelerations, and the vectors beside it.
  Status take_largest(std::string_view group) {
    std::size_t longest = 0;
    for (const Table& table : tables_)
      if (is_within(table.array->path, group)) longest = std::max(longest, table.rows);
    const auto rank = [&](const Table& table) {
      return std::tuple(may_be_samples(table, longest), kind_of(table), table.figures());
    };
    const Table* largest = nullptr;
    for (const Table& table : tables_)
      if (is_within(table.array->path, group) &&
          (largest == nullptr || rank(table) > rank(*largest)))
        largest = &table;
    if (largest == nullptr) return Error{Errc::too_few_samples, nothing_there()};
    chosen_.insert(largest->array);
    for (const Table* vector : vectors_beside(*largest)) chosen_.insert(vector->array);
    return Done{};
  }

  [[nodiscard]] std::string nothing_there() const {
    const std::string there = contents(catalogue_, {});
    if (there.empty()) return "holds no variable";
    return fmt::format("holds no table of samples (numbers, at most {} channels): it has {}",
                       most_channels, there);
  }

  Status take_named(const std::string& name) {
    const auto named = [&](const Array& array) { return array.path == name; };
    const auto alike = [&](const Array& array) { return lower(array.path) == lower(name); };
    auto array = std::ranges::find_if(catalogue_.arrays, named);
    if (array == catalogue_.arrays.end()) array = std::ranges::find_if(catalogue_.arrays, alike);
    if (array != catalogue_.arrays.end()) {
      chosen_.insert(&*array);
      if (table_of(*array)) return Done{};
      return Error{Errc::invalid_argument,
                   fmt::format("{} ({}) is not a table of samples, at most {} channels",
                               array->path, array->description(), most_channels)};
    }
    if (!name.empty() && take_largest(name)) return Done{};
    return Error{Errc::invalid_argument,
                 fmt::format("has no variable {} that is a table of samples; it has {}", name,
                             contents(catalogue_, {}))};
  }

  /// Adds the time beside the named arrays.
  Status add_time() {
    for (const Table& table : tables_) {
      if (!chosen_.contains(table.array)) continue;
      const auto vectors = vectors_beside(table);
      std::vector<std::string> names;
      names.reserve(vectors.size());
      for (const Table* vector : vectors) names.push_back(vector->name());
      if (const auto time = time_among(names, options_)) chosen_.insert(vectors[*time]->array);
      break;
    }
    return Done{};
  }

  [[nodiscard]] std::vector<const Table*> vectors_beside(const Table& table) const {
    std::vector<const Table*> vectors;
    for (const Table& other : tables_)
      if (other.width == 1 && other.rows == table.rows &&
          other.array->group() == table.array->group())
        vectors.push_back(&other);
    return vectors;
  }

  /// In the struct of the table, or an enclosing one.
  [[nodiscard]] const Array* rate_beside(const Table& table) const {
    for (const Array& array : catalogue_.arrays) {
      const bool is_number = !array.is_complex && std::ranges::all_of(array.shape, [](auto length) {
        return length == 1;
      });
      if (is_number && is_within(table.array->group(), array.group()) &&
          is_rate_name(Table{&array}.name()))
        return &array;
    }
    return nullptr;
  }

  [[nodiscard]] const Array* start_beside(const Table& table) const {
    for (const Array& array : catalogue_.arrays)
      if (size_of(array) == 1 && array.class_name == "int64" &&
          array.group() == table.array->group() && Table{&array}.name() == "start_ns")
        return &array;
    return nullptr;
  }

  void report(Choice& choice) const {
    std::string read;
    for (const Table& table : choice.tables) {
      const Array& array = *table.array;
      read += fmt::format("{}{} ({})", read.empty() ? "" : ", ", array.path, array.description());
      if (table.is_turned && table.width > 1)
        choice.notes.push_back({Severity::info, array.path + " is channels x samples: turned"});
      if (array.is_complex)
        choice.notes.push_back(
            {Severity::warning, array.path + " is complex: its real part is read"});
    }
    choice.notes.insert(choice.notes.begin(),
                        {Severity::info, fmt::format("{}: {} read", catalogue_.version, read)});
    std::set<const Array*> used(chosen_);
    used.insert(choice.rate);
    used.insert(choice.start);
    if (const std::string others = contents(catalogue_, used); !others.empty())
      choice.notes.push_back(
          {Severity::info, fmt::format("also in the file: {}", others), {Advice{"variable"}}});
    if (catalogue_.is_cut)
      choice.notes.push_back(
          {Severity::warning, fmt::format("of the arrays in the file only the first {} were "
                                          "looked at",
                                          most_arrays)});
  }

  const Catalogue& catalogue_;
  const ReadOptions& options_;
  std::vector<Table> tables_;
  std::set<const Array*> chosen_;
};

}  // namespace

Result<std::vector<Table>> chosen_tables(const std::vector<Table>& tables,
                                         const std::set<const Array*>& chosen) {
  std::vector<Table> found;
  for (const Table& table : tables)
    if (chosen.contains(table.array)) found.push_back(table);
  for (const Table& table : found)
    if (table.rows != found.front().rows)
      return Error{Errc::invalid_argument,
                   fmt::format("{} has {} samples and {} {}: they do not belong together",
                               found.front().array->path, found.front().rows, table.array->path,
                               table.rows)};
  return found;
}

bool is_rate_name(std::string_view name) {
  constexpr std::array<std::string_view, 12> names{
      "fs",           "fshz",           "samplerate",
      "sampleratehz", "samplingrate",   "rate",
      "samplingfreq", "samplefreq",     "samplingfrequency",
      "framerate",    "samplingratehz", "ratehz"};
  return is_one_of(name, names);
}

bool is_rate(double rate_hz) {
  return rate_hz > 0.01 && rate_hz < 1e7;
}

TableKind kind_of(const Table& table) {
  constexpr std::array<std::string_view, 11> others{
      "gyr", "omega", "ang", "mag", "euler", "quat", "vel", "pos", "temp", "orient", "baro"};
  const std::string name = bare_name(table.name());
  const auto is_part = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  // "x" alone may be an axis of any quantity.
  const bool is_axis = !name.empty() && name[0] >= 'x' && name[0] <= 'z';
  if (is_accelerometer_name(name) && !is_axis) return TableKind::acceleration;
  if (std::ranges::any_of(others, is_part)) return TableKind::other;
  return lower(table.array->path).find("acc") != std::string::npos ? TableKind::acceleration
                                                                   : TableKind::unknown;
}

bool may_be_samples(const Table& table, std::size_t longest) {
  constexpr std::size_t fewest = 10, share = 20;
  return table.rows >= std::min(fewest, longest) && table.rows * share >= longest;
}

bool is_asked_for(const Table& table, const ReadOptions& options) {
  return std::ranges::any_of(
      options.channels, [&](const std::string& channel) { return is_channel_of(channel, table); });
}

std::set<const Array*> arrays_asked_for(const std::vector<Table>& tables,
                                        const ReadOptions& options) {
  std::set<const Array*> found;
  std::set<std::size_t> lengths;
  for (const std::string& channel : options.channels) {
    bool any = false;
    for (const Table& table : tables) {
      if (!is_channel_of(channel, table)) continue;
      any = true;
      found.insert(table.array);
      lengths.insert(table.rows);
    }
    if (!any) return {};
  }
  return lengths.size() == 1 ? found : std::set<const Array*>{};
}

std::string Table::name() const {
  const std::string_view path = array->path;
  const std::size_t point = path.find_last_of("./");
  return std::string(point == std::string_view::npos ? path : path.substr(point + 1));
}

std::optional<Table> table_of(const Array& array) {
  Table table{&array};
  const std::size_t first = array.shape.front();
  const std::size_t last = array.shape.back();
  table.rows = std::max(first, last);
  table.is_turned = last > first;
  if (table.rows < 2) return std::nullopt;
  table.width = size_of(array) / table.rows;
  const bool is_table =
      table.width >= 1 && table.width <= most_channels && table.width <= table.rows;
  if (!is_table) return std::nullopt;
  return table;
}

Result<Choice> choose_tables(const Catalogue& catalogue, const ReadOptions& options) {
  Chooser chooser(catalogue, options);
  if (const Status done = chooser.run(); !done) return done.error();
  return chooser.choice();
}

}  // namespace proofmass::io::matlab
