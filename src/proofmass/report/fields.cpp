#include "proofmass/report/fields.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <limits>

#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using Kind = Shape::Kind;

Field with_number(std::string key, const std::optional<double>& value, Shape shape, About about) {
  Field field{std::move(key), std::move(shape), std::move(about)};
  if (value) field.scalar = Value(*value);
  return field;
}

Value value_of(const Field& field) {
  if (field.figure && field.shape.std_nullable)
    return Object{
        {"value", field.figure->value}, {"std", field.figure->std}, {"unit", field.shape.unit}};
  if (field.shape.kind == Kind::quantity) return quantity(field.figure, field.shape.unit);
  if (!field.fields) return field.scalar;
  if (field.shape.kind != Kind::list) return json_of(*field.fields);
  Array items;
  if (field.items)
    for (std::size_t k = 0; k < field.items->count; ++k)
      items.emplace_back(json_of(field.items->at(k)));
  else
    for (const Field& item : *field.fields) items.push_back(value_of(item));
  return items;
}

// Keys of one object that are null for the same reason.
struct NullGroup {
  std::string reason;
  std::vector<std::string> keys;
};

// Null keys of one object. `pattern` is its path without indices ("positions[]"), which it shares
// with the other objects of its list.
struct Nulls {
  std::string place, pattern;
  NullGroup group;
  bool named = false;
};

void add_null(std::vector<NullGroup>& groups, const std::string& reason, const std::string& key) {
  const auto same = std::ranges::find(groups, reason, &NullGroup::reason);
  if (same == groups.end())
    groups.push_back({reason, {key}});
  else
    same->keys.push_back(key);
}

std::string without_index(const std::string& key) {
  std::string out;
  bool index = false;
  for (const char c : key) {
    if (c == ']') index = false;
    if (!index) out += c;
    if (c == '[') index = true;
  }
  return out;
}

std::string inside(const std::string& place, const std::string& key) {
  return place.empty() ? key : place + "." + key;
}

// Identifying text of an object in a list.
std::string name_in(const Fields& fields) {
  for (const Field& field : fields)
    if (field.key == "name" || field.key == "file" || field.key == "channel" || field.key == "id" ||
        field.key == "key")
      if (const auto* name = std::get_if<std::string>(&field.scalar.state())) return *name;
  return {};
}

// Path of an object in the document, with and without list indices.
struct Path {
  std::string place, pattern;
};

void collect(const Fields& fields, const Path& path, std::vector<Nulls>& out);

// Nulls directly in a list belong to the enclosing object; objects in a list are treated by
// themselves.
void look(const Field& field,
          const std::string& key,
          const Path& path,
          std::vector<NullGroup>& groups,
          std::vector<Nulls>& below) {
  if (is_absent(field)) return add_null(groups, field.about.why_null, key);
  if (field.figure && std::isnan(field.figure->std))
    return add_null(groups, field.about.why_no_std, key + ".std");
  if (!field.fields) return;
  if (field.shape.kind != Kind::list)
    return collect(*field.fields,
                   {inside(path.place, key), inside(path.pattern, without_index(key))}, below);
  for (std::size_t i = 0; i < field.fields->size(); ++i) {
    const Field& item = (*field.fields)[i];
    if (item.about.why_null.empty() && is_absent(item))
      add_null(groups, field.about.why_null, fmt::format("{}[{}]", key, i));
    else
      look(item, fmt::format("{}[{}]", key, i), path, groups, below);
  }
}

void collect(const Fields& fields, const Path& path, std::vector<Nulls>& out) {
  const std::string name = name_in(fields);
  const bool named = !path.place.empty() && !name.empty();
  const Path own{named ? fmt::format("{} ({})", path.place, name) : path.place, path.pattern};
  std::vector<NullGroup> groups;
  std::vector<Nulls> below;
  for (const Field& field : fields) look(field, field.key, own, groups, below);
  for (NullGroup& group : groups) out.push_back({own.place, own.pattern, std::move(group), named});
  out.insert(out.end(), below.begin(), below.end());
}

std::string sentence(const Nulls& nulls) {
  const std::vector<std::string>& keys = nulls.group.keys;
  const std::string_view link = nulls.place.empty()                ? ""
                                : !nulls.named && keys.size() == 1 ? "."
                                                                   : ": ";
  return fmt::format("{}{}{}: null: {}", nulls.place, link, fmt::join(keys, ", "),
                     nulls.group.reason);
}

std::string sentence(const Nulls& nulls, std::size_t times) {
  return fmt::format("{}: {}: null ({} times): {}", nulls.pattern,
                     fmt::join(nulls.group.keys, ", "), times, nulls.group.reason);
}

struct Shown {
  std::string operator()(std::monostate) const { return std::string(absent); }
  std::string operator()(bool value) const { return value ? "yes" : "no"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(std::uint64_t value) const { return grouped(value); }
  std::string operator()(double value) const { return significant(value, 4); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const Array&) const { return {}; }
  std::string operator()(const Object&) const { return {}; }
};

}  // namespace

namespace field {

Field text(std::string key, std::string_view value, About about) {
  return {std::move(key), {Kind::text}, std::move(about), Value(value)};
}

Field text_or_null(std::string key, std::string_view value, About about) {
  return {std::move(key),
          {.kind = Kind::text, .nullable = true},
          std::move(about),
          value.empty() ? Value() : Value(value)};
}

Field choice(std::string key,
             std::string_view value,
             std::vector<std::string> choices,
             About about) {
  return {std::move(key),
          {.kind = Kind::choice, .choices = std::move(choices)},
          std::move(about),
          Value(value)};
}

Field flag(std::string key, bool value, About about) {
  return {std::move(key), {Kind::flag}, std::move(about), Value(value)};
}

Field flag(std::string key, const std::optional<bool>& value, About about) {
  return {std::move(key), {.kind = Kind::flag, .nullable = true}, std::move(about), or_null(value)};
}

Field count(std::string key, std::size_t value, About about) {
  return {std::move(key), {Kind::count}, std::move(about), Value(std::uint64_t{value})};
}

Field number(std::string key, double value, About about) {
  const bool nullable = !about.why_null.empty();
  return with_number(std::move(key), value, {.kind = Kind::number, .nullable = nullable},
                     std::move(about));
}

Field number(std::string key, const std::optional<double>& value, About about) {
  return with_number(std::move(key), value, {.kind = Kind::number, .nullable = true},
                     std::move(about));
}

Field integer(std::string key, const std::optional<int>& value, About about) {
  const bool nullable = !about.why_null.empty();
  return {std::move(key),
          {.kind = Kind::integer, .nullable = nullable},
          std::move(about),
          or_null(value)};
}

Field magnitude(std::string key, const std::optional<double>& value, About about) {
  const bool nullable = !about.why_null.empty();
  return with_number(std::move(key), value,
                     {.kind = Kind::number, .nullable = nullable, .not_negative = true},
                     std::move(about));
}

Field probability(std::string key, const std::optional<double>& value, About about) {
  Field field = magnitude(std::move(key), value, std::move(about));
  field.shape.maximum = 1.0;
  return field;
}

Field measured(std::string key,
               const std::optional<Uncertain>& value,
               std::string_view unit,
               About about) {
  Field field{std::move(key),
              {.kind = Kind::quantity, .unit = std::string(unit), .nullable = true},
              std::move(about)};
  if (value && std::isfinite(value->value) && std::isfinite(value->std)) field.figure = value;
  return field;
}

Field measured(std::string key,
               const std::optional<double>& value,
               const std::optional<double>& std,
               std::string_view unit,
               About about) {
  Field field{
      std::move(key),
      {.kind = Kind::quantity, .unit = std::string(unit), .nullable = true, .std_nullable = true},
      std::move(about)};
  if (value && std::isfinite(*value))
    field.figure = Uncertain{
        *value, std && std::isfinite(*std) ? *std : std::numeric_limits<double>::quiet_NaN()};
  return field;
}

Field interval(std::string key, const std::optional<std::array<double, 2>>& ends, About about) {
  Field field{
      std::move(key), {.kind = Kind::list, .nullable = true, .length = 2}, std::move(about)};
  if (ends) field.fields = Fields{number({}, (*ends)[0]), number({}, (*ends)[1])};
  return field;
}

Field object(std::string key, Fields fields, About about) {
  Field field{std::move(key), {Kind::object}, std::move(about)};
  field.fields = std::move(fields);
  return field;
}

Field object_or_null(std::string key, std::optional<Fields> fields, About about) {
  Field field{std::move(key), {.kind = Kind::object, .nullable = true}, std::move(about)};
  field.fields = std::move(fields);
  return field;
}

Field map(std::string key, Fields entries, About about) {
  Field field{std::move(key), {Kind::map}, std::move(about)};
  field.fields = std::move(entries);
  return field;
}

Field list(std::string key, Fields items, About about) {
  Field field{std::move(key), {Kind::list}, std::move(about)};
  field.fields = std::move(items);
  return field;
}

Field fixed_list(std::string key, Fields items, About about) {
  Field field = list(std::move(key), std::move(items), std::move(about));
  field.shape.length = field.fields->size();
  return field;
}

Field without_value(Field field, std::string_view why) {
  field.shape.nullable = true;
  field.about.why_null = why;
  field.scalar = {};
  field.figure.reset();
  field.fields.reset();
  return field;
}

Field list_or_null(std::string key, std::optional<Fields> items, About about) {
  Field field{std::move(key), {.kind = Kind::list, .nullable = true}, std::move(about)};
  field.fields = std::move(items);
  return field;
}

Field texts(std::string key, const std::vector<std::string>& items, About about) {
  Fields all;
  for (const std::string& item : items) all.push_back(text({}, item));
  Field field = list(std::move(key), std::move(all), std::move(about));
  field.shape.of_texts = true;
  return field;
}

Field notes(const std::vector<Note>& notes) {
  return texts("notes", report::texts(notes, Severity::info),
               {.meaning = "what was found while reading and computing, warnings included"});
}

}  // namespace field

void append(Fields& fields, Fields more) {
  for (Field& field : more) fields.push_back(std::move(field));
}

bool is_absent(const Field& field) {
  if (field.shape.kind == Kind::quantity) return !field.figure;
  return !field.fields && field.scalar.is_null();
}

Object json_of(const Fields& fields) {
  Object out;
  for (const Field& field : fields) out.push_back({field.key, value_of(field)});
  return out;
}

std::vector<std::string> reasons_for_nulls(const Fields& fields) {
  constexpr std::size_t most_listed = 3;
  std::vector<Nulls> all;
  collect(fields, {}, all);
  std::vector<std::string> out;
  std::vector<std::vector<Nulls>> alike;
  for (Nulls& one : all) {
    if (one.group.reason.empty()) one.group.reason = "this recording does not determine it";
    const auto same = std::ranges::find_if(alike, [&](const std::vector<Nulls>& others) {
      const Nulls& other = others.front();
      return other.pattern == one.pattern && other.group.keys == one.group.keys &&
             other.group.reason == one.group.reason;
    });
    if (same == alike.end())
      alike.push_back({std::move(one)});
    else
      same->push_back(std::move(one));
  }
  for (const std::vector<Nulls>& some : alike) {
    if (some.size() > most_listed)
      out.push_back(sentence(some.front(), some.size()));
    else
      for (const Nulls& one : some) out.push_back(sentence(one));
  }
  return out;
}

std::string shown_value(const Field& field) {
  if (field.shape.kind == Kind::list) {
    std::vector<std::string> items;
    for (const Field& item : *field.fields) items.push_back(shown_value(item));
    return fmt::format("({})", fmt::join(items, ", "));
  }
  if (const double* value = std::get_if<double>(&field.scalar.state());
      value != nullptr && field.about.display)
    return fmt::format("{} {}", significant(*value * field.about.display->factor, 2),
                       field.about.display->unit);
  if (field.shape.kind != Kind::quantity) return std::visit(Shown{}, field.scalar.state());
  // In a conditional expression with a literal, the string itself would become a temporary.
  const std::string_view unit = field.shape.unit;
  const Display display = field.about.display.value_or(Display{unit == "1" ? "" : unit});
  std::optional<Uncertain> figure = scaled(field.figure, display.factor);
  if (figure && std::isnan(figure->std)) figure->std = 0.0;  // shown without a standard deviation
  return with_std(figure, display.unit, absent);
}

}  // namespace proofmass::report
