#pragma once

#include <set>
#include <string>
#include <string_view>

namespace proofmass::io {

/// Makes names that MATLAB takes for variables and fields: a letter, then letters, digits and
/// underscores, 63 at most, none a keyword, none twice whatever the case.
class MatNames {
 public:
  [[nodiscard]] std::string name_for(std::string_view text);

 private:
  std::set<std::string> taken_;
};

}  // namespace proofmass::io
