#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "proofmass/core/contract.hpp"

namespace proofmass {

/// What went wrong, coarse enough for a caller to branch on.
enum class Errc {
  invalid_argument,  ///< what the caller asked for makes no sense
  unwritable,        ///< a file that cannot be written: no room, no permission, no such folder
  unreadable,        ///< no such file, no permission, a failing disk
  corrupt,           ///< bytes that cannot be what they claim to be
  unsupported,       ///< understood, but not built in
  device,            ///< a device or a connection that is not there, refuses, or has gone
  too_few_samples,
  not_finite,
  not_positive_definite,
  not_observable,  ///< the data cannot tell, however long one computes
};

/// A failure that data or the outside world can cause. A bug is not an Error: see contract.hpp.
struct Error {
  Errc code;
  std::string message;  ///< one line for a person: what, and the limit that was broken

  /// The same error, seen from further out: "line 12: bad number" at "wheel.csv" becomes
  /// "wheel.csv: line 12: bad number".
  [[nodiscard]] Error at(std::string_view where) const {
    return {code, std::string(where) + ": " + message};
  }
};

/// An Error as an exception, for those who call value() without looking.
class ResultError : public std::runtime_error {
 public:
  explicit ResultError(const Error& error) : std::runtime_error(error.message), code_(error.code) {}
  [[nodiscard]] Errc code() const { return code_; }

 private:
  Errc code_;
};

/// Either a T or the Error that prevented it: the part of std::expected that we use, made safe for
/// C++20. A temporary Result hands its value over by value, so `for (auto& p : f().value())` does
/// not dangle, and `*f()` does not compile.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  [[nodiscard]] bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  /// Throws ResultError if there is none.
  [[nodiscard]] const T& value() const& {
    return has_value() ? **this : throw ResultError(error());
  }
  [[nodiscard]] T value() && {
    return has_value() ? std::get<T>(std::move(state_)) : throw ResultError(error());
  }

  /// Looking without asking is a bug, and is treated as one.
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

/// The Result of what is done for its effect: `return Done{};`
struct Done {};
using Status = Result<Done>;

}  // namespace proofmass
