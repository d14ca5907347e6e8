#include "verb.hpp"

namespace proofmass::app {

// Each is defined next to its flags, in a source of its name.
Verb budget_verb();
Verb calibrate_verb();
Verb convert_verb();
Verb drift_verb();
Verb drive_verb();
Verb fleet_verb();
Verb inspect_verb();
Verb motor_verb();
Verb noise_verb();
Verb record_verb();
Verb recover_verb();
Verb sensor_verb();
Verb serve_verb();
Verb simulate_verb();
Verb thesis_verb();
Verb tilt_verb();
Verb track_verb();
Verb tumble_verb();
Verb tune_verb();
Verb wheel_verb();

std::vector<Verb> all_verbs() {
  return {inspect_verb(),   serve_verb(),  convert_verb(), noise_verb(),    drift_verb(),
          calibrate_verb(), tumble_verb(), sensor_verb(),  wheel_verb(),    drive_verb(),
          track_verb(),     tilt_verb(),   motor_verb(),   tune_verb(),     budget_verb(),
          fleet_verb(),     record_verb(), recover_verb(), simulate_verb(), thesis_verb()};
}

}  // namespace proofmass::app
