#pragma once

#include <cstddef>
#include <hdf5.h>
#include <string>
#include <vector>

#include "proofmass/io/hdf5/handle.hpp"

namespace proofmass::io::hdf5 {

/// A field of a compound type that is a number, or an array of them.
struct NumericField {
  std::string name;
  std::size_t columns = 1;
};

struct CompoundFields {
  std::vector<NumericField> numeric;  ///< in the order of the type
  std::vector<std::string> others;    ///< "label (text)"

  [[nodiscard]] std::size_t columns() const;
};

/// The fields of a compound type; none for any other type.
[[nodiscard]] CompoundFields fields_of(hid_t type);

/// The memory type of those fields: consecutive doubles.
[[nodiscard]] Handle memory_type_of(const CompoundFields& fields);

}  // namespace proofmass::io::hdf5
