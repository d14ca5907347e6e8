#pragma once

#include <set>
#include <string>
#include <string_view>

namespace proofmass::io::matlab {

/// Makes valid MATLAB names of variables and fields: a letter, then letters, digits and
/// underscores, at most 63, no keywords, unique ignoring case.
class Names {
 public:
  [[nodiscard]] std::string name_for(std::string_view text);

 private:
  std::set<std::string> taken_;
};

}  // namespace proofmass::io::matlab
