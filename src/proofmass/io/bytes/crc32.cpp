#include "proofmass/io/bytes/crc32.hpp"

#include <libdeflate.h>

namespace proofmass::io {

std::uint32_t crc32(std::uint32_t so_far, std::string_view bytes) {
  // A null pointer would mean the initial value.
  return bytes.empty() ? so_far : libdeflate_crc32(so_far, bytes.data(), bytes.size());
}

}  // namespace proofmass::io
