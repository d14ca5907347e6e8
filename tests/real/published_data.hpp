#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace proofmass {

/// The folder of the published recordings, whether it exists or not.
inline std::filesystem::path published_data() {
  if (const char* given = std::getenv("PROOFMASS_DATA")) return given;
  return std::filesystem::path(PROOFMASS_SOURCE_DIR) / "../shared/data";
}

/// Message of a test that is skipped because a file is missing.
inline std::string absent(const std::filesystem::path& file) {
  return "NO PUBLISHED RECORDINGS: set PROOFMASS_DATA to their folder (" + file.string() +
         " is not there)";
}

}  // namespace proofmass
