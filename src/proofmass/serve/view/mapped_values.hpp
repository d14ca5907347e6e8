#pragma once

#include <cstddef>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/core/view.hpp"

namespace proofmass::serve {

/// A file of doubles as memory: what is looked at is read, and nothing else.
class MappedValues {
 public:
  MappedValues() = default;
  /// Errors: unreadable.
  [[nodiscard]] static Result<MappedValues> open(const std::string& path);
  MappedValues(MappedValues&& other) noexcept;
  MappedValues& operator=(MappedValues&& other) noexcept;
  ~MappedValues();

  [[nodiscard]] View<double> values() const { return {data_, size_}; }

 private:
  const double* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace proofmass::serve
