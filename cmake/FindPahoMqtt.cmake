# Finds Eclipse Paho's library of synchronous MQTT, without TLS, as PahoMqtt::client: Debian's has no
# CMake package of its own.
find_path(PahoMqtt_INCLUDE_DIR MQTTClient.h)
find_library(PahoMqtt_LIBRARY NAMES paho-mqtt3c)
mark_as_advanced(PahoMqtt_INCLUDE_DIR PahoMqtt_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(PahoMqtt REQUIRED_VARS PahoMqtt_LIBRARY PahoMqtt_INCLUDE_DIR)

if(PahoMqtt_FOUND AND NOT TARGET PahoMqtt::client)
  add_library(PahoMqtt::client UNKNOWN IMPORTED)
  set_target_properties(PahoMqtt::client PROPERTIES
    IMPORTED_LOCATION "${PahoMqtt_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${PahoMqtt_INCLUDE_DIR}")
endif()
