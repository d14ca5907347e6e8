#include "proofmass/io/hdf5/handle.hpp"

#include <array>
#include <fmt/format.h>
#include <sys/resource.h>

namespace proofmass::io::hdf5 {

std::string failure_reason() {
  std::string reason;
  const auto keep_first = [](unsigned, const H5E_error2_t* error, void* into) -> herr_t {
    if (error->desc == nullptr) return 0;
    *static_cast<std::string*>(into) = error->desc;
    return 1;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &reason);
  return reason.empty() ? "no reason given" : reason.substr(0, 300);
}

Result<Handle> open_source(const Source& source) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
#if H5_VERSION_GE(1, 10, 7)
  H5Pset_file_locking(access, false, true);
#endif
  // The default driver resolves the name of a link, which such a file does not have.
  constexpr std::size_t step = std::size_t{1} << 20;
  if (source.is_nameless) H5Pset_fapl_core(access, step, false);
  Handle file(H5Fopen(source.path.c_str(), H5F_ACC_RDONLY, access), H5Fclose);
  if (!file)
    return Error{
        Errc::corrupt,
        fmt::format("is damaged or breaks off: the HDF5 library says \"{}\"", failure_reason())};
  const struct rlimit no_file{0, 0};
  ::setrlimit(RLIMIT_NOFILE, &no_file);
  return file;
}

std::string real_part(hid_t type) {
  constexpr std::array<std::array<std::string_view, 2>, 2> spellings{
      {{"real", "imag"}, {"r", "i"}}};
  if (H5Tget_class(type) != H5T_COMPOUND || H5Tget_nmembers(type) != 2) return {};
  std::array<std::string, 2> names;
  for (unsigned i = 0; i < 2; ++i) {
    if (H5Tget_member_class(type, i) != H5T_FLOAT && H5Tget_member_class(type, i) != H5T_INTEGER)
      return {};
    char* name = H5Tget_member_name(type, i);
    if (name == nullptr) return {};
    names[i] = name;
    H5free_memory(name);
  }
  for (const auto& spelling : spellings)
    if (names[0] == spelling[0] && names[1] == spelling[1]) return names[0];
  return {};
}

}  // namespace proofmass::io::hdf5
