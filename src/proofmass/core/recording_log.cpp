#include "proofmass/core/recording_log.hpp"

namespace proofmass {

std::string_view name_of(EventKind kind) {
  switch (kind) {
    case EventKind::lost:
      return "lost";
    case EventKind::overrun:
      return "overrun";
    case EventKind::gap:
      return "gap";
    case EventKind::stalled:
      return "stalled";
    case EventKind::disconnected:
      return "disconnected";
    case EventKind::reconnected:
      return "reconnected";
    case EventKind::clock_jump:
      return "clock_jump";
    case EventKind::clock_dead:
      return "clock_dead";
    case EventKind::host_jump:
      return "host_jump";
    case EventKind::disk_full:
      return "disk_full";
    case EventKind::triggered:
      return "triggered";
    case EventKind::rotated:
      return "rotated";
    case EventKind::note:
      break;
  }
  return "note";
}

}  // namespace proofmass
