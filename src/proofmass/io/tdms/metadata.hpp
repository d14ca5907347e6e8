#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/tdms/cursor.hpp"
#include "proofmass/io/tdms/layout.hpp"
#include "proofmass/io/tdms/map.hpp"

namespace proofmass::io::tdms {

/// The objects of a file, and those with values in the current segment, updated with each segment's
/// metadata.
class Metadata {
 public:
  /// Reads the metadata at the cursor. `new_list`: they list all objects of the segment; else they
  /// modify the list of the previous segment. Errors: corrupt, unsupported; objects read before are
  /// kept unchanged.
  [[nodiscard]] Status read(Cursor& cursor, bool new_list);

  /// Channels with values in the segment, in the order of the list.
  [[nodiscard]] std::vector<Part> parts() const;
  /// Equal as long as parts() is.
  [[nodiscard]] std::string key() const;
  [[nodiscard]] std::vector<Object>& objects() { return objects_; }

 private:
  struct Listed {
    std::uint32_t object = 0;
    std::uint32_t index = 0;
  };

  [[nodiscard]] Status read_object(Cursor& cursor);
  [[nodiscard]] Status read_index(Cursor& cursor, std::uint32_t object);
  void list(std::uint32_t object, std::optional<std::uint32_t> index);
  void note_kind(std::uint32_t object, const Index& index);
  [[nodiscard]] std::uint32_t object_of(const std::string& path);
  [[nodiscard]] std::uint32_t known_index(const Index& index);

  std::vector<Object> objects_;
  std::unordered_map<std::string, std::uint32_t> by_path_;
  std::vector<std::optional<std::uint32_t>> last_index_;  ///< per object
  std::vector<std::unique_ptr<const Index>> indices_;
  std::unordered_map<std::string, std::uint32_t> by_index_;
  std::vector<std::uint32_t> listed_;  ///< objects of the current segment
  std::vector<bool> is_listed_;
  std::vector<std::optional<std::uint32_t>> index_now_;  ///< per object; none: no values
};

}  // namespace proofmass::io::tdms
