// Replaces the comedi sources if comedilib was not available at build time.
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {

Result<std::unique_ptr<Source>> open_comedi(SourceUri&, const OpenOptions&) {
  return Error{
      Errc::unsupported,
      "this program was built without comedilib; build it where libcomedi-dev is installed"};
}

Result<std::vector<FoundSource>> find_comedi() {
  return std::vector<FoundSource>{};
}

}  // namespace proofmass::acquire
