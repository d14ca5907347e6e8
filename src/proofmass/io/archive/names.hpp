#pragma once

#include <string>
#include <string_view>

namespace proofmass::io {

/// A file name for a line of text: control characters are replaced by '?'.
[[nodiscard]] inline std::string plain_name(std::string_view name) {
  std::string out(name);
  for (char& c : out)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  return out;
}

/// The last part of a path: "meta/time.csv" is "time.csv".
[[nodiscard]] inline std::string_view file_part(std::string_view path) {
  const auto stroke = path.rfind('/');
  return stroke == std::string_view::npos ? path : path.substr(stroke + 1);
}

/// The path without its last part: "meta/time.csv" is "meta/"; empty at the top.
[[nodiscard]] inline std::string_view folder_part(std::string_view path) {
  return path.substr(0, path.size() - file_part(path).size());
}

/// A path without the extensions of compression and format: "a/Raw Data.csv.xz" is "a/Raw Data".
[[nodiscard]] std::string without_endings(std::string_view path);

}  // namespace proofmass::io
