#include "proofmass/io/hdf5/storage.hpp"

#include <array>
#include <cstdint>
#include <fmt/format.h>

#include "proofmass/io/hdf5/handle.hpp"

namespace proofmass::io::hdf5 {
namespace {

std::string chunk_refusal(hid_t creation) {
  constexpr std::uint64_t most_figures = std::uint64_t{32} << 20;
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  const int rank = H5Pget_chunk(creation, H5S_MAX_RANK, chunk.data());
  std::uint64_t figures = rank < 1 ? 0 : 1;
  for (int d = 0; d < rank; ++d)
    if (__builtin_mul_overflow(figures, chunk[static_cast<std::size_t>(d)], &figures))
      return "damaged";
  if (figures == 0) return "damaged";
  return figures > most_figures ? "in chunks of more than 256 MiB" : "";
}

std::string filter_refusal(hid_t creation, unsigned number) {
  std::array<char, 64> name{};
  std::size_t values = 0;
  unsigned flags = 0;
  const H5Z_filter_t filter =
      H5Pget_filter2(creation, number, &flags, &values, nullptr, name.size(), name.data(), nullptr);
  name.back() = '\0';
  if (filter >= 0 && H5Zfilter_avail(filter) > 0) return {};
  const std::string what = name[0] != '\0' ? name.data() : fmt::format("filter {}", filter);
  return fmt::format("packed by {}, which is not built in: use gzip", what);
}

}  // namespace

std::string type_name(hid_t type) {
  const std::size_t bits = H5Tget_size(type) * 8;
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      if (bits > 64) return {};
      return fmt::format("{}int{}", H5Tget_sign(type) == H5T_SGN_NONE ? "u" : "", bits);
    case H5T_FLOAT:
      return bits > 128 ? "" : fmt::format("float{}", bits);
    case H5T_ENUM:
      return bits > 64 ? "" : H5Tget_nmembers(type) == 2 ? "bool" : "enumeration";
    case H5T_COMPOUND:
      return real_part(type).empty() ? "" : "complex";
    default:
      return {};
  }
}

std::string_view kind_of(hid_t type) {
  switch (H5Tget_class(type)) {
    case H5T_STRING:
      return "text";
    case H5T_COMPOUND:
      return "compound";
    case H5T_REFERENCE:
      return "references";
    case H5T_OPAQUE:
      return "opaque";
    case H5T_BITFIELD:
      return "bits";
    case H5T_ARRAY:
    case H5T_VLEN:
      return "arrays in an array";
    default:
      return "no numbers";
  }
}

std::string storage_refusal(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  if (!creation) return "damaged";
  if (H5Pget_external_count(creation) != 0) return "in another file";
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL) return "put together of others";
  std::string refusal = layout == H5D_CHUNKED ? chunk_refusal(creation) : "";
  const int filters = H5Pget_nfilters(creation);
  for (int i = 0; i < filters && refusal.empty(); ++i)
    refusal = filter_refusal(creation, static_cast<unsigned>(i));
  return refusal;
}

}  // namespace proofmass::io::hdf5
