#include "proofmass/sensor/sensor_file.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <locale>
#include <sstream>
#include <toml++/toml.h>
#include <utility>

#include "proofmass/sensor/file/fields.hpp"

namespace proofmass::sensor {
namespace {

using Units = std::initializer_list<std::string_view>;

/// Location of a figure in the file, and its permitted units.
struct Place {
  std::string path;  ///< "noise.white"
  Units units;
};

/// Thrown on every failure, with its line.
struct Failure {
  Error error;
};

[[noreturn]] void fail(const toml::node& node, std::string_view path, std::string_view why) {
  throw Failure{
      {Errc::corrupt, fmt::format("line {}: {}: {}", node.source().begin.line, path, why)}};
}

double number(const toml::node& node, std::string_view path) {
  const auto value = node.is_number() ? node.value<double>() : std::nullopt;
  if (!value || !std::isfinite(*value)) fail(node, path, "must be a finite number");
  return *value;
}

std::string text(const toml::node& node, std::string_view path) {
  if (const auto* string = node.as_string()) return string->get();
  if (const auto* date = node.as_date()) {
    const toml::date d = date->get();
    return fmt::format("{:04}-{:02}-{:02}", d.year, d.month, d.day);
  }
  fail(node, path, "must be a text in quotes");
}

/// One number for all three axes, or an array of three.
std::array<double, 3> three_numbers(const toml::node& node, std::string_view path) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    const double all = number(node, path);
    return {all, all, all};
  }
  if (array->size() != 3) fail(node, path, "must have three values, for the axes x, y, z");
  return {number((*array)[0], path), number((*array)[1], path), number((*array)[2], path)};
}

FigureUnit unit_of(const toml::table& table, const Place& place) {
  const toml::node* node = table.get("unit");
  if (node == nullptr)
    fail(table, place.path,
         fmt::format("has no unit; expected {}", fmt::join(place.units, " or ")));
  const std::string symbol = text(*node, place.path + ".unit");
  const auto unit = parse_figure_unit(symbol);
  if (!unit || std::ranges::find(place.units, unit->si_symbol) == place.units.end())
    fail(*node, place.path,
         fmt::format("cannot be in \"{}\"; expected {} or a multiple of it", symbol,
                     fmt::join(place.units, " or ")));
  return *unit;
}

void only_known_keys(const toml::table& table, const Place& place) {
  for (const auto& [key, node] : table)
    if (key.str() != "value" && key.str() != "std" && key.str() != "unit" && key.str() != "origin")
      fail(node, place.path + "." + std::string(key.str()),
           "is not known; a figure has value, std, unit and origin");
}

/// The figure of a table, on three axes; an empty table {} gives none.
AxisFigures table_figures(const toml::node& node, const Place& place) {
  const toml::table* table = node.as_table();
  if (table == nullptr)
    fail(node, place.path, "must be like { value = 1.0, std = 0.1, unit = \"…\", origin = \"…\" }");
  if (table->empty()) return {};
  only_known_keys(*table, place);
  const toml::node* value = table->get("value");
  if (value == nullptr) fail(node, place.path, "has no value");
  const auto values = three_numbers(*value, place.path + ".value");
  Figure figure{0.0, std::nullopt, unit_of(*table, place), ""};
  if (const toml::node* origin = table->get("origin"))
    figure.origin = text(*origin, place.path + ".origin");
  std::optional<std::array<double, 3>> stds;
  if (const toml::node* std = table->get("std")) {
    stds = three_numbers(*std, place.path + ".std");
    if (std::ranges::any_of(*stds, [](double s) { return s < 0.0; }))
      fail(*std, place.path + ".std", "must not be negative");
  }
  AxisFigures figures;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    figure.value = values[axis];
    if (stds) figure.std = (*stds)[axis];
    figures[axis] = figure;
  }
  return figures;
}

void read_figure(const toml::node& node, const Place& place, AxisFigures& figures) {
  const toml::array* array = node.as_array();
  if (array == nullptr) {
    figures = table_figures(node, place);
    return;
  }
  if (array->size() != 3) fail(node, place.path, "must have three tables, for the axes x, y, z");
  for (std::size_t axis = 0; axis < 3; ++axis)
    figures[axis] = table_figures((*array)[axis], place)[axis];
}

void read_figure(const toml::node& node, const Place& place, std::optional<Figure>& figure) {
  const toml::table* table = node.as_table();
  for (const char* key : {"value", "std"})
    if (table != nullptr && table->get(key) != nullptr && table->get(key)->is_array())
      fail(node, place.path, "is one figure, not one for each axis");
  figure = table_figures(node, place)[0];
}

/// `order`: what the rows are of.
template <std::size_t count>
std::array<std::array<double, count>, count> covariance(const toml::node& node,
                                                        std::string_view path,
                                                        std::string_view order) {
  const std::string shape = fmt::format("must be {0} rows of {0} numbers: {1}", count, order);
  std::array<std::array<double, count>, count> matrix{};
  const toml::array* rows = node.as_array();
  if (rows == nullptr || rows->size() != count) fail(node, path, shape);
  for (std::size_t i = 0; i < count; ++i) {
    const toml::array* row = (*rows)[i].as_array();
    if (row == nullptr || row->size() != count) fail((*rows)[i], path, shape);
    for (std::size_t j = 0; j < count; ++j) matrix[i][j] = number((*row)[j], path);
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (matrix[i][j] != matrix[j][i]) fail(node, path, "must be symmetric");
  return matrix;
}

/// Makes a value print on one line, as required after "key = ".
void make_inline(toml::node& node) {
  if (toml::table* table = node.as_table()) {
    table->is_inline(true);
    for (auto&& [key, child] : *table) make_inline(child);
  } else if (toml::array* array = node.as_array()) {
    for (toml::node& child : *array) make_inline(child);
  }
}

std::string toml_of(toml::node& node) {
  make_inline(node);
  std::ostringstream out;
  out.imbue(std::locale::classic());
  node.visit([&out](const auto& value) { out << toml::toml_formatter{value}; });
  return out.str();
}

/// Removes the known entries from the tree; the remainder is unknown.
class Reader {
 public:
  explicit Reader(toml::table& root) : root_(root) {
    for (const std::string_view name : sections)
      if (const toml::node* node = root_.get(name); node != nullptr && !node->is_table())
        fail(*node, name, fmt::format("must be a section, [{}]", name));
  }

  SensorFile read() {
    SensorModel& model = file_.model;
    visit_texts(model, [this](std::string_view section, std::string_view key, std::string& member) {
      take(section, key,
           [&](const toml::node& node, const std::string& path) { member = text(node, path); });
    });
    visit_figures(
        model, [this](std::string_view section, std::string_view key, Units units, auto& member) {
          take(section, key, [&](const toml::node& node, const std::string& path) {
            read_figure(node, {path, units}, member);
          });
        });
    take("calibration", "covariance", [&](const toml::node& node, const std::string& path) {
      model.calibration.covariance =
          covariance<9>(node, path, "bias x y z, scale x y z, misalignment yz zy zx");
    });
    take("gyroscope", "covariance", [&](const toml::node& node, const std::string& path) {
      model.gyroscope.covariance = covariance<gyroscope_figures>(node, path, gyroscope_order);
    });
    for (auto&& [key, node] : root_) {
      if (std::ranges::find(sections, key.str()) == sections.end()) {
        keep("", key.str(), node);
      } else {
        for (auto&& [inner, child] : *node.as_table()) keep(key.str(), inner.str(), child);
      }
    }
    return std::move(file_);
  }

 private:
  template <class Use>
  void take(std::string_view section, std::string_view key, Use use) {
    toml::table* table = root_.get_as<toml::table>(section);
    const toml::node* node = table == nullptr ? nullptr : table->get(key);
    if (node == nullptr) return;
    use(*node, fmt::format("{}.{}", section, key));
    table->erase(key);
  }

  void keep(std::string_view section, std::string_view key, toml::node& node) {
    const auto line = node.source().begin.line;
    file_.model.unknown.push_back({std::string(section), std::string(key), toml_of(node)});
    file_.notes.push_back(
        {Severity::warning,
         fmt::format("line {}: {}{}{} is not known to this version; kept, not used", line, section,
                     section.empty() ? "" : ".", key)});
  }

  toml::table& root_;
  SensorFile file_;
};

}  // namespace

Result<SensorFile> parse_sensor_file(std::string_view text, std::string_view name) {
  try {
    toml::table root = toml::parse(text);
    SensorFile file = Reader(root).read();
    for (Note& note : file.notes) note.text = fmt::format("{}: {}", name, note.text);
    return file;
  } catch (const Failure& failure) {
    return failure.error.at(name);
  } catch (const toml::parse_error& error) {
    return Error{Errc::corrupt, fmt::format("{}: line {}: no TOML: {}", name,
                                            error.source().begin.line, error.description())};
  }
}

Result<SensorFile> read_sensor_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in.is_open() || in.bad())
    return Error{Errc::unreadable, path + ": cannot be read; expected a sensor file (TOML)"};
  return parse_sensor_file(text, path);
}

}  // namespace proofmass::sensor
