#pragma once

#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <vector>

#include "proofmass/report/schema.hpp"

// Support for the tests of schemas.
namespace proofmass::report {

/// docs/schema must have this file with this text; it is written if PROOFMASS_WRITE_SCHEMAS is set.
inline void expect_schema_file(const std::string& name, const std::string& schema) {
  const std::string path =
      std::string(PROOFMASS_SOURCE_DIR) + "/docs/schema/" + name + ".schema.json";
  if (std::getenv("PROOFMASS_WRITE_SCHEMAS") != nullptr) std::ofstream(path) << schema;
  std::stringstream file;
  file << std::ifstream(path).rdbuf();
  EXPECT_TRUE(schema == file.str())
      << path << " differs: PROOFMASS_WRITE_SCHEMAS=1 before this test program regenerates it";
}

/// docs/schema must agree with json_schema().
inline void expect_schema(const std::string& description,
                          const std::vector<Document>& samples,
                          const std::string& name = {}) {
  expect_schema_file(name.empty() ? samples.front().page.verb : name,
                     json_schema(description, samples, name));
}

/// docs/schema must agree with json_schema_of_kinds().
inline void expect_schema_of_kinds(const std::string& description,
                                   const std::vector<std::vector<Document>>& kinds) {
  expect_schema_file(kinds.front().front().page.verb, json_schema_of_kinds(description, kinds));
}

}  // namespace proofmass::report
