#include "proofmass/core/version.hpp"

namespace proofmass {

std::string_view version() {
  return PROOFMASS_VERSION;
}

}  // namespace proofmass
