#pragma once

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// A connection error with advice on what to do on the phone.
[[nodiscard]] inline Error phyphox_gone(const Error& why) {
  return {why.code, "no phyphox: " + why.message +
                        "; switch remote access on in the experiment's menu, keep the app in "
                        "front, and have phone "
                        "and computer in the same network"};
}
[[nodiscard]] inline Error sensor_server_gone(const Error& why) {
  return {why.code,
          "no SensorServer: " + why.message +
              "; start the server in the app, and have phone and computer in the same network"};
}

}  // namespace proofmass::acquire
