#include "cli/exit_status.hpp"

namespace proofmass::app {

ExitStatus status_of(const Error& error, Stage stage) {
  switch (error.code) {
    case Errc::invalid_argument:
      return usage;
    case Errc::unsupported:
      return stage == Stage::reading ? bad_input : usage;
    case Errc::device:
      return bad_device;
    case Errc::unwritable:
      return failed;
    case Errc::unreadable:
    case Errc::corrupt:
    case Errc::too_few_samples:
    case Errc::not_finite:
      return stage == Stage::writing ? failed : bad_input;
    case Errc::not_positive_definite:
    case Errc::not_observable:
      break;
  }
  return failed;
}

}  // namespace proofmass::app
