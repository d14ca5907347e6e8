// Replaces the IIO sources if libiio was not available at build time.
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {

Result<std::unique_ptr<Source>> open_iio(SourceUri&, const OpenOptions&) {
  return Error{Errc::unsupported,
               "this program was built without libiio; build it where libiio-dev is installed"};
}

Result<std::vector<FoundSource>> find_iio() {
  return std::vector<FoundSource>{};
}

}  // namespace proofmass::acquire
