#include "proofmass/io/hdf5/fields.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "proofmass/io/hdf5/storage.hpp"

namespace proofmass::io::hdf5 {
namespace {

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return (kind == H5T_INTEGER || kind == H5T_FLOAT || kind == H5T_ENUM) && !type_name(type).empty();
}

/// Number of columns of a field: 0 if it is neither a number nor an array of numbers.
std::size_t columns_of(hid_t type) {
  constexpr hsize_t most_columns = 4096;
  if (is_number(type)) return 1;
  if (H5Tget_class(type) != H5T_ARRAY || H5Tget_array_ndims(type) != 1) return 0;
  const Handle element(H5Tget_super(type), H5Tclose);
  hsize_t length = 0;
  if (!element || !is_number(element) || H5Tget_array_dims2(type, &length) < 0) return 0;
  return length <= most_columns ? static_cast<std::size_t>(length) : 0;
}

}  // namespace

std::size_t CompoundFields::columns() const {
  std::size_t columns = 0;
  for (const NumericField& field : numeric) columns += field.columns;
  return columns;
}

CompoundFields fields_of(hid_t type) {
  CompoundFields fields;
  const int count = H5Tget_class(type) == H5T_COMPOUND ? H5Tget_nmembers(type) : 0;
  for (unsigned i = 0; i < static_cast<unsigned>(std::max(count, 0)); ++i) {
    char* text = H5Tget_member_name(type, i);
    if (text == nullptr) continue;
    const std::string name = text;
    H5free_memory(text);
    const Handle member(H5Tget_member_type(type, i), H5Tclose);
    const std::size_t columns = member ? columns_of(member) : 0;
    if (columns > 0)
      fields.numeric.push_back({name, columns});
    else
      fields.others.push_back(fmt::format("{} ({})", name, member ? kind_of(member) : "damaged"));
  }
  return fields;
}

Handle memory_type_of(const CompoundFields& fields) {
  Handle type(H5Tcreate(H5T_COMPOUND, fields.columns() * sizeof(double)), H5Tclose);
  std::size_t offset = 0;
  for (const NumericField& field : fields.numeric) {
    const hsize_t length = field.columns;
    const Handle row(H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, &length), H5Tclose);
    const std::size_t place = offset * sizeof(double);
    offset += field.columns;
    const bool is_row = field.columns > 1;
    if (!type ||
        H5Tinsert(type, field.name.c_str(), place, is_row ? row : hid_t{H5T_NATIVE_DOUBLE}) < 0)
      return {-1, H5Tclose};
  }
  return type;
}

}  // namespace proofmass::io::hdf5
