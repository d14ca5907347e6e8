#pragma once

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <vector>

#include "proofmass/report/schema.hpp"

// For tests.
namespace proofmass::report {

/// docs/schema is what json_schema() makes. With PROOFMASS_WRITE_SCHEMAS set the file is written.
inline void expect_schema(const std::string& description,
                          const std::vector<Document>& samples,
                          const std::string& name = {}) {
  const std::string schema = json_schema(description, samples, name);
  const std::string path = std::string(PROOFMASS_SOURCE_DIR) + "/docs/schema/" +
                           (name.empty() ? samples.front().page.verb : name) + ".schema.json";
  if (std::getenv("PROOFMASS_WRITE_SCHEMAS") != nullptr) std::ofstream(path) << schema;
  std::stringstream file;
  file << std::ifstream(path).rdbuf();
  EXPECT_TRUE(schema == file.str())
      << path << " differs: PROOFMASS_WRITE_SCHEMAS=1 before this test program regenerates it";
}

}  // namespace proofmass::report
