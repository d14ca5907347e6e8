#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include <zlib.h>

#include "proofmass/io/matlab/mat_specimens.hpp"

// Writes NumPy arrays and zip archives of them for tests.
namespace proofmass::io::specimen {

/// An .npy file of version 1 with the given dictionary.
inline std::string npy_text(std::string dictionary, const std::string& figures) {
  dictionary += '\n';
  return std::string("\x93NUMPY\x01\0", 8) +
         bytes_of<std::uint16_t>({static_cast<std::uint16_t>(dictionary.size())}) + dictionary +
         figures;
}

inline std::string npy_file(const std::string& descr,
                            const std::string& shape,
                            const std::string& figures,
                            bool fortran = false) {
  return npy_text("{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
                      ", 'shape': " + shape + ", }",
                  figures);
}

struct ZipMember {
  std::string name;
  std::string content;
};

/// A zip archive, its members stored, or compressed as by np.savez_compressed.
inline std::string zip(const std::vector<ZipMember>& members, bool is_packed = false) {
  std::string files;
  std::string directory;
  for (const ZipMember& member : members) {
    const auto crc =
        static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(member.content.data()),
                                         static_cast<unsigned>(member.content.size())));
    const std::string data = is_packed ? deflated(member.content, -15) : member.content;
    const std::string sizes =
        bytes_of<std::uint32_t>({crc, static_cast<std::uint32_t>(data.size()),
                                 static_cast<std::uint32_t>(member.content.size())}) +
        bytes_of<std::uint16_t>({static_cast<std::uint16_t>(member.name.size()), 0});
    const std::string kind =
        bytes_of<std::uint16_t>({20, 0, static_cast<std::uint16_t>(is_packed ? 8 : 0), 0, 0x21});
    directory += "PK\x01\x02" + bytes_of<std::uint16_t>({20}) + kind + sizes +
                 bytes_of<std::uint16_t>({0, 0, 0}) +
                 bytes_of<std::uint32_t>({0, static_cast<std::uint32_t>(files.size())}) +
                 member.name;
    files += "PK\x03\x04" + kind + sizes + member.name + data;
  }
  const auto count = static_cast<std::uint16_t>(members.size());
  return files + directory + "PK\x05\x06" + bytes_of<std::uint16_t>({0, 0, count, count}) +
         bytes_of<std::uint32_t>({static_cast<std::uint32_t>(directory.size()),
                                  static_cast<std::uint32_t>(files.size())}) +
         bytes_of<std::uint16_t>({0});
}

}  // namespace proofmass::io::specimen
