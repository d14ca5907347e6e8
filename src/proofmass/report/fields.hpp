#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"
#include "proofmass/report/json.hpp"

// The entries of a verb's result. Each states its key, its meaning, and its value or the reason for
// its absence; the JSON document, its schema, the reasons of nulls and the printed rows are
// generated from them.
namespace proofmass::report {

struct Field;
using Fields = std::vector<Field>;

/// Display unit of a quantity: shown = value · factor.
struct Display {
  std::string_view unit = {};
  double factor = 1.0;
};

/// Metadata of an entry.
struct About {
  std::string meaning = {};             ///< for the schema: conventions, signs, when it is null
  std::string label = {};               ///< printed label; empty: the entry is in the document only
  std::string why_null = {};            ///< reason, if the value is absent
  std::optional<Display> display = {};  ///< for a number; absent: as in the document
  std::string why_no_std = {};          ///< reason, if a quantity has no standard deviation
};

/// Type and constraints of a value.
struct Shape {
  enum class Kind { text, choice, flag, count, integer, number, quantity, list, object, map };

  Kind kind = Kind::text;
  std::string unit = {};                  ///< for a quantity
  std::vector<std::string> choices = {};  ///< for a choice
  bool nullable = false;
  bool not_negative = false;               ///< for a number
  bool std_nullable = false;               ///< for a quantity
  bool of_texts = false;                   ///< for a list
  std::optional<std::size_t> length = {};  ///< for a list of fixed length
  std::optional<double> maximum = {};      ///< for a number or count
  std::string pattern = {};  ///< regular expression: for a text, or for the keys of a map
  bool decides = false;      ///< for a choice: the other entries of the object depend on it
};

struct Field {
  std::string key;  ///< empty in a list
  Shape shape;
  About about = {};
  Value scalar = {};                     ///< null if there is no value, and for lists and objects
  std::optional<Uncertain> figure = {};  ///< for a quantity; std is NaN if absent
  std::optional<Fields> fields = {};     ///< for a list or an object
  /// A long list, of which `fields` has the first item only.
  struct Items {
    std::size_t count = 0;
    std::function<Fields(std::size_t)> at = {};  ///< the entries of item i
  };
  std::optional<Items> items = {};
};

// One function for each kind. A number that is not finite becomes absent.
namespace field {

[[nodiscard]] Field text(std::string key, std::string_view value, About about = {});
/// Absent if the text is empty.
[[nodiscard]] Field text_or_null(std::string key, std::string_view value, About about = {});
/// One of a fixed set of words.
[[nodiscard]] Field choice(std::string key,
                           std::string_view value,
                           std::vector<std::string> choices,
                           About about = {});
[[nodiscard]] Field flag(std::string key, bool value, About about = {});
[[nodiscard]] Field flag(std::string key, const std::optional<bool>& value, About about = {});
[[nodiscard]] Field count(std::string key, std::size_t value, About about = {});
/// A whole number that may be negative.
[[nodiscard]] Field integer(std::string key, const std::optional<int>& value, About about = {});
[[nodiscard]] Field number(std::string key, double value, About about = {});
[[nodiscard]] Field number(std::string key, const std::optional<double>& value, About about = {});
/// A number ≥ 0: a length, a standard deviation, a probability.
[[nodiscard]] Field magnitude(std::string key,
                              const std::optional<double>& value,
                              About about = {});
/// A probability, or another number from 0 to 1.
[[nodiscard]] Field probability(std::string key,
                                const std::optional<double>& value,
                                About about = {});
/// {"value", "std", "unit"}.
[[nodiscard]] Field measured(std::string key,
                             const std::optional<Uncertain>& value,
                             std::string_view unit,
                             About about = {});
/// The same, for a value that may be known without its standard deviation.
[[nodiscard]] Field measured(std::string key,
                             const std::optional<double>& value,
                             const std::optional<double>& std,
                             std::string_view unit,
                             About about = {});
/// [lower, upper], or null.
[[nodiscard]] Field interval(std::string key,
                             const std::optional<std::array<double, 2>>& ends,
                             About about = {});
[[nodiscard]] Field object(std::string key, Fields fields, About about = {});
/// An object that may be absent.
[[nodiscard]] Field object_or_null(std::string key, std::optional<Fields> fields, About about = {});
/// Entries of one kind under keys that are not fixed.
[[nodiscard]] Field map(std::string key, Fields entries, About about = {});
/// The keys of the items are left empty.
[[nodiscard]] Field list(std::string key, Fields items, About about = {});
/// A list of fixed length.
[[nodiscard]] Field fixed_list(std::string key, Fields items, About about = {});
/// The same entry with its value replaced by a reason for its absence.
[[nodiscard]] Field without_value(Field field, std::string_view why);
/// A list that may be absent.
[[nodiscard]] Field list_or_null(std::string key, std::optional<Fields> items, About about = {});

/// A list of strings.
[[nodiscard]] Field texts(std::string key, const std::vector<std::string>& items, About about = {});

/// True if the type fixes the number of values: std::array, fixed-size vectors of Eigen.
template <class Range>
inline constexpr bool has_fixed_size = requires { std::tuple_size<Range>::value; } ||
                                       requires { requires(Range::SizeAtCompileTime > 0); };

/// A list of numbers.
template <class Range>
[[nodiscard]] Field numbers(std::string key, const Range& range, About about = {}) {
  Fields items;
  for (const double value : range) items.push_back(number({}, value));
  if constexpr (has_fixed_size<Range>)
    return fixed_list(std::move(key), std::move(items), std::move(about));
  else
    return list(std::move(key), std::move(items), std::move(about));
}

/// A list with one object for each element: `fields_of(element)`.
template <class Range, class FieldsOf>
[[nodiscard]] Field records(std::string key,
                            const Range& range,
                            FieldsOf fields_of,
                            About about = {}) {
  Fields items;
  for (const auto& element : range) items.push_back(object({}, fields_of(element)));
  return list(std::move(key), std::move(items), std::move(about));
}

/// The same for long lists (a million elements): the entries of an element are made while the
/// document is written; `range` must live until then. No entry may be absent.
template <class Range, class FieldsOf>
[[nodiscard]] Field long_records(std::string key,
                                 const Range& range,
                                 FieldsOf fields_of,
                                 About about = {}) {
  Fields first;
  if (!range.empty()) first.push_back(object({}, fields_of(range.front())));
  Field field = list(std::move(key), std::move(first), std::move(about));
  field.items = Field::Items{range.size(),
                             [&range, fields_of](std::size_t k) { return fields_of(range[k]); }};
  return field;
}

/// The texts of all notes, under "notes".
[[nodiscard]] Field notes(const std::vector<Note>& notes);

}  // namespace field

void append(Fields& fields, Fields more);

[[nodiscard]] bool is_absent(const Field& field);

/// The entries as JSON, in order.
[[nodiscard]] Object json_of(const Fields& fields);

/// One sentence for each group of nulls:
/// - those of one object with the same reason: "sensors[0] (a.csv): radius_m, bias[0]: null: this
///   recording does not determine them";
/// - those of more than three objects of a list: "positions[]: std: null (24 times): ...".
[[nodiscard]] std::vector<std::string> reasons_for_nulls(const Fields& fields);

/// The value in its display unit, a list in parentheses; "not determined" if absent.
[[nodiscard]] std::string shown_value(const Field& field);

}  // namespace proofmass::report
