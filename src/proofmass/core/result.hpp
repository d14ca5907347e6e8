#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "proofmass/core/contract.hpp"

namespace proofmass {

/// Kind of failure, coarse enough for a caller to branch on.
enum class Errc {
  invalid_argument,  ///< the request is invalid
  unwritable,        ///< a file that cannot be written: no room, no permission, no such folder
  unreadable,        ///< no such file, no permission, a failing disk
  corrupt,           ///< bytes that violate their format
  unsupported,       ///< understood, but not built in
  device,            ///< a device or connection that is absent, refuses, or is lost
  too_few_samples,
  not_finite,
  not_positive_definite,
  not_observable,  ///< not identifiable from the data, whatever the computation
};

/// An option of the analysis that would resolve a finding or a failure: "radius", or "gravity" with
/// the value "removed". Each front end spells it in its own way.
struct Advice {
  std::string option;
  std::string value{};
};

/// A failure caused by data or by the outside world. A bug is not an Error: see contract.hpp.
struct Error {
  Errc code;
  std::string message;  ///< one line for the user: the failure and the limit that was exceeded
  std::vector<Advice> advice{};

  /// The same error with outer context: "line 12: bad number" at "wheel.csv" becomes "wheel.csv:
  /// line 12: bad number".
  [[nodiscard]] Error at(std::string_view where) const {
    return {code, std::string(where) + ": " + message, advice};
  }
};

/// An Error as an exception, for callers that use value() without a check.
class ResultError : public std::runtime_error {
 public:
  explicit ResultError(Error error) : std::runtime_error(error.message), error_(std::move(error)) {}
  [[nodiscard]] const Error& error() const { return error_; }

 private:
  Error error_;
};

/// Either a T or the Error that prevented it: the part of std::expected that we use, made safe for
/// C++20. A temporary Result returns its value by value, so `for (auto& p : f().value())` does not
/// dangle, and `*f()` does not compile.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Throws ResultError if there is no value.
  [[nodiscard]] const T& value() const& {
    return has_value() ? **this : throw ResultError(error());
  }
  [[nodiscard]] T value() && {
    return has_value() ? std::get<T>(std::move(state_)) : throw ResultError(error());
  }

  /// Access without a prior check is a bug and aborts.
  const T& operator*() const& {
    PM_EXPECTS(has_value());
    return *std::get_if<T>(&state_);
  }
  const T* operator->() const& { return &**this; }
  const T& operator*() const&& = delete;
  const T* operator->() const&& = delete;
  [[nodiscard]] const Error& error() const {
    PM_EXPECTS(!has_value());
    return *std::get_if<Error>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

/// Result of an operation that returns no value: `return Done{};`
struct Done {};
using Status = Result<Done>;

}  // namespace proofmass
