// Replaces MQTT if Paho's library was not available at build time.
#include "proofmass/acquire/source_list.hpp"

namespace proofmass::acquire {

Result<std::unique_ptr<Source>> open_mqtt(SourceUri&, const OpenOptions&) {
  return Error{Errc::unsupported,
               "this program was built without MQTT; build it where libpaho-mqtt-dev is installed"};
}

}  // namespace proofmass::acquire
