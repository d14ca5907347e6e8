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

// The entries of a verb's result. Each states its key, its meaning and its value, or the reason why
// there is none; the JSON document, its schema, the list of reasons and the rows that people read
// are all made from them.
namespace proofmass::report {

struct Field;
using Fields = std::vector<Field>;

/// Unit in which people read a quantity: shown = value · factor.
struct Display {
  std::string_view unit = {};
  double factor = 1.0;
};

/// What an entry states beside its value.
struct About {
  std::string meaning = {};             ///< for the schema: conventions, signs, when it is null
  std::string label = {};               ///< for people; empty: only in the document
  std::string why_null = {};            ///< the reason, should there be no value
  std::optional<Display> display = {};  ///< of a number; absent: as in the document
  std::string why_no_std = {};  ///< the reason, should a quantity have no standard deviation
};

/// What may stand under a key.
struct Shape {
  enum class Kind { text, choice, flag, count, integer, number, quantity, list, object, map };

  Kind kind = Kind::text;
  std::string unit = {};                  ///< of a quantity
  std::vector<std::string> choices = {};  ///< of a choice
  bool nullable = false;
  bool not_negative = false;               ///< of a number
  bool std_nullable = false;               ///< of a quantity
  bool of_texts = false;                   ///< of a list
  std::optional<std::size_t> length = {};  ///< of a list that always has as many items
  std::optional<double> maximum = {};      ///< of a number or count
  std::string pattern = {};  ///< regular expression: of a text, or of the keys of a map
  bool decides = false;      ///< of a choice: which entries the object has depends on it
};

struct Field {
  std::string key;  ///< empty in a list
  Shape shape;
  About about = {};
  Value scalar = {};                     ///< null where there is no value, and in lists and objects
  std::optional<Uncertain> figure = {};  ///< of a quantity; its std NaN where there is none
  std::optional<Fields> fields = {};     ///< of a list or an object
  /// Of a long list, whose first item alone is in `fields`.
  struct Items {
    std::size_t count = 0;
    std::function<Fields(std::size_t)> at = {};  ///< the entries of an item
  };
  std::optional<Items> items = {};
};

// One function for each kind. A number that is not finite is absent.
namespace field {

[[nodiscard]] Field text(std::string key, std::string_view value, About about = {});
/// A text that is absent where it is empty.
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
/// A number that cannot be negative: a length, a standard deviation, a probability.
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
/// The same, where the value may be known without its standard deviation.
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
/// The items' keys are left empty.
[[nodiscard]] Field list(std::string key, Fields items, About about = {});
/// A list that always has as many items.
[[nodiscard]] Field fixed_list(std::string key, Fields items, About about = {});
/// The same entry without its value.
[[nodiscard]] Field without_value(Field field, std::string_view why);
/// A list that may be absent.
[[nodiscard]] Field list_or_null(std::string key, std::optional<Fields> items, About about = {});

/// A list of strings.
[[nodiscard]] Field texts(std::string key, const std::vector<std::string>& items, About about = {});

/// Whether the type says how many values there are: std::array, fixed vectors of Eigen.
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

/// The same for as many as a million elements: their entries are made one at a time, while the
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

/// The entries as JSON, in their order.
[[nodiscard]] Object json_of(const Fields& fields);

/// One sentence for each null, those of one object with one reason together:
/// "sensors[0] (a.csv): radius_m, bias[0]: null: this recording does not determine them"; the same
/// of more than three objects of a list together, too: "positions[]: std: null (24 times): ...".
[[nodiscard]] std::vector<std::string> reasons_for_nulls(const Fields& fields);

/// The value as people read it, in its display unit, a list in parentheses; "not determined" where
/// there is none.
[[nodiscard]] std::string shown_value(const Field& field);

}  // namespace proofmass::report
