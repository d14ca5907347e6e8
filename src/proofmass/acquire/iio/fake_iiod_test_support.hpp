#pragma once

#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/network/peer_test_support.hpp"

namespace proofmass::acquire {

/// A running rig/iiod/fake_iiod.py.
class FakeIiod {
 public:
  explicit FakeIiod(std::vector<std::string> options) : process_(words_of(std::move(options))) {}

  [[nodiscard]] std::string uri() const {
    return "iio:ip:127.0.0.1:" + std::to_string(process_.port());
  }

 private:
  static std::vector<std::string> words_of(std::vector<std::string> options) {
    options.insert(options.begin(), {"python3", PROOFMASS_SOURCE_DIR "/rig/iiod/fake_iiod.py"});
    return options;
  }

  PeerProcess process_;
};

}  // namespace proofmass::acquire
