#include "proofmass/io/hdf5/attributes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "proofmass/io/hdf5/handle.hpp"

namespace proofmass::io::hdf5 {
namespace {

constexpr std::size_t most_texts = 64;
constexpr std::size_t longest_text = 4096;

/// Up to a NUL or the end, without trailing blanks.
std::string trimmed(const char* text, std::size_t size) {
  std::string out(text, ::strnlen(text, std::min(size, longest_text)));
  while (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

std::vector<std::string> fixed_texts(hid_t attribute, hid_t type, std::size_t count) {
  constexpr std::size_t most_bytes = std::size_t{1} << 20;
  const std::size_t size = H5Tget_size(type);
  if (size == 0 || size > most_bytes || count > most_bytes / size) return {};
  std::vector<char> bytes(size * count);
  if (H5Aread(attribute, type, bytes.data()) < 0) return {};
  std::vector<std::string> texts;
  texts.reserve(count);
  for (std::size_t i = 0; i < count; ++i) texts.push_back(trimmed(bytes.data() + i * size, size));
  return texts;
}

std::vector<std::string> variable_texts(hid_t attribute, hid_t space, std::size_t count) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  const Handle stored(H5Aget_type(attribute), H5Tclose);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5Tget_cset(stored));
  std::vector<char*> pointers(count, nullptr);
  if (H5Aread(attribute, type, pointers.data()) < 0) return {};
  std::vector<std::string> texts;
  texts.reserve(count);
  for (const char* text : pointers)
    texts.push_back(text == nullptr ? "" : trimmed(text, longest_text));
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
  return texts;
}

Attribute read_attribute(hid_t attribute, const char* name) {
  Attribute read{.owner = {}, .name = name};
  const Handle type(H5Aget_type(attribute), H5Tclose);
  const Handle space(H5Aget_space(attribute), H5Sclose);
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  if (!type || points < 1 || static_cast<std::size_t>(points) > most_texts) return read;
  const auto count = static_cast<std::size_t>(points);
  const H5T_class_t kind = H5Tget_class(type);
  if (kind == H5T_STRING)
    read.texts = H5Tis_variable_str(type) > 0 ? variable_texts(attribute, space, count)
                                              : fixed_texts(attribute, type, count);
  double figure = 0.0;
  if (count == 1 && (kind == H5T_INTEGER || kind == H5T_FLOAT) &&
      H5Aread(attribute, H5T_NATIVE_DOUBLE, &figure) >= 0)
    read.figure = figure;
  std::int64_t integer = 0;
  if (read.figure && kind == H5T_INTEGER && H5Aread(attribute, H5T_NATIVE_INT64, &integer) >= 0)
    read.integer = integer;
  return read;
}

}  // namespace

bool has_attribute(hid_t object, const char* name) {
  return H5Aexists(object, name) > 0;
}

std::string text_attribute(hid_t object, const char* name) {
  if (!has_attribute(object, name)) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute) return {};
  const Attribute read = read_attribute(attribute, name);
  return read.texts.size() == 1 ? read.texts[0] : "";
}

std::vector<Attribute> attributes_of(hid_t object) {
  std::vector<Attribute> found;
  const auto keep = [](hid_t owner, const char* name, const H5A_info_t*, void* into) noexcept {
    auto& list = *static_cast<std::vector<Attribute>*>(into);
    const Handle attribute(H5Aopen(owner, name, H5P_DEFAULT), H5Aclose);
    if (!attribute) return herr_t{0};
    Attribute read = read_attribute(attribute, name);
    if (!read.texts.empty() || read.figure) list.push_back(std::move(read));
    return herr_t{list.size() < most_texts ? 0 : 1};
  };
  hsize_t index = 0;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, &index, keep, &found);
  return found;
}

}  // namespace proofmass::io::hdf5
