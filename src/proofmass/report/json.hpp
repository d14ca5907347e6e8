#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "proofmass/core/quantity.hpp"
#include "proofmass/core/recording.hpp"

// JSON values and documents.
namespace proofmass::report {

class Value;
struct Member;
using Array = std::vector<Value>;
using Object = std::vector<Member>;  ///< keys in insertion order

/// A JSON value. A double that is not finite becomes null, since JSON has no NaN.
class Value {
 public:
  Value();
  Value(std::nullptr_t);         // NOLINT(google-explicit-constructor)
  Value(bool value);             // NOLINT(google-explicit-constructor)
  Value(int value);              // NOLINT(google-explicit-constructor)
  Value(std::int64_t value);     // NOLINT(google-explicit-constructor)
  Value(std::uint64_t value);    // NOLINT(google-explicit-constructor)
  Value(double value);           // NOLINT(google-explicit-constructor)
  Value(const char* text);       // NOLINT(google-explicit-constructor)
  Value(std::string text);       // NOLINT(google-explicit-constructor)
  Value(std::string_view text);  // NOLINT(google-explicit-constructor)
  Value(Array items);            // NOLINT(google-explicit-constructor)
  Value(Object members);         // NOLINT(google-explicit-constructor)
  // Defined where Member is complete, which the vector of them needs.
  Value(const Value& other);
  Value(Value&& other) noexcept;
  Value& operator=(const Value& other);
  Value& operator=(Value&& other) noexcept;
  ~Value();

  [[nodiscard]] bool is_null() const { return state_.index() == 0; }

  using State = std::variant<std::monostate,
                             bool,
                             std::int64_t,
                             std::uint64_t,
                             double,
                             std::string,
                             Array,
                             Object>;
  [[nodiscard]] const State& state() const { return state_; }

 private:
  State state_;
};

struct Member {
  std::string key;
  Value value;
};

/// Head of a document; the version of Proofmass is added.
struct DocumentHead {
  std::string verb;
  std::vector<std::string> input;     ///< files as the user named them
  std::vector<std::string> warnings;  ///< sentences, including the reason of every null
};

/// The document of one run: "proofmass", "verb", "input", "warnings", then the body; indented by
/// two, with a final newline. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string to_json(const DocumentHead& head, const Object& body);

/// A value by itself, indented by two, without a final newline.
[[nodiscard]] std::string json_text(const Value& value);

/// The value, or null.
template <class T>
[[nodiscard]] Value or_null(const std::optional<T>& value) {
  return value ? Value(*value) : Value();
}

/// {"value", "std", "unit"}; null if the figure is absent or not finite.
[[nodiscard]] Value quantity(const std::optional<Uncertain>& figure, std::string_view unit);

/// Value and standard deviation multiplied by `factor`, for units other than SI.
[[nodiscard]] std::optional<Uncertain> scaled(const std::optional<Uncertain>& figure,
                                              double factor);

/// The texts of the notes of severity `least` or higher.
[[nodiscard]] std::vector<std::string> texts(const std::vector<Note>& notes, Severity least);

/// An array of strings, of numbers, …
template <class Range>
[[nodiscard]] Array array_of(const Range& items) {
  return Array(std::begin(items), std::end(items));
}

}  // namespace proofmass::report
