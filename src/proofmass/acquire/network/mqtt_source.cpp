#include <MQTTClient.h>
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <random>
#include <string>

#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/byte_pump.hpp"

namespace proofmass::acquire {
namespace {

constexpr int quality_of_service = 1;  // each message at least once
constexpr std::string_view not_again = "was lost, and with it what was sent meanwhile";

/// Requested broker and topic.
struct MqttPlace {
  std::string host, topic;
  unsigned short port = 1883;
  std::optional<std::string> user{}, password{};
};

std::string words_of(int code) {
  const char* words = MQTTClient_strerror(code);
  return words == nullptr ? fmt::format("error {}", code) : words;
}

/// Refusal codes of a broker. Source: MQTT 3.1.1, table 3.1.
std::string refusal_of(int code) {
  switch (code) {
    case 1:
      return "it speaks another version of MQTT";
    case 2:
      return "it does not take this client's name";
    case 3:
      return "it is not ready";
    case 4:
      return "user or password is wrong: give user= and password=";
    case 5:
      return "it wants a user: give user= and password=";
    default:
      return code < 0 ? "no response: is the broker running, and the port right?" : words_of(code);
  }
}

/// A connection with one topic.
class MqttFeed final : public BytePump {
 public:
  explicit MqttFeed(MqttPlace place) : place_(std::move(place)) {}
  ~MqttFeed() override {
    if (client_ == nullptr) return;
    constexpr int at_once_ms = 100;
    if (MQTTClient_isConnected(client_) != 0) MQTTClient_disconnect(client_, at_once_ms);
    MQTTClient_destroy(&client_);
  }

  Status connect(std::chrono::milliseconds patience) {
    const std::string uri = fmt::format("tcp://{}:{}", place_.host, place_.port);
    const std::string name = fmt::format("proofmass-{:08x}", std::random_device{}());
    if (const int code = MQTTClient_create(&client_, uri.c_str(), name.c_str(),
                                           MQTTCLIENT_PERSISTENCE_NONE, nullptr);
        code != MQTTCLIENT_SUCCESS)
      return failed("no connection", words_of(code));
    MQTTClient_connectOptions options = MQTTClient_connectOptions_initializer;
    options.keepAliveInterval = 10;
    options.cleansession = 1;
    options.connectTimeout = static_cast<int>(
        std::max<std::int64_t>(1, std::chrono::ceil<std::chrono::seconds>(patience).count()));
    if (place_.user) options.username = place_.user->c_str();
    if (place_.password) options.password = place_.password->c_str();
    if (const int code = MQTTClient_connect(client_, &options); code != MQTTCLIENT_SUCCESS)
      return failed("no connection", refusal_of(code));
    const int code = MQTTClient_subscribe(client_, place_.topic.c_str(), quality_of_service);
    if (code != MQTTCLIENT_SUCCESS)
      return failed(fmt::format("topic {}", place_.topic), "the broker does not give it");
    return Done{};
  }

  Result<Fed> read(std::span<char> into, std::chrono::milliseconds patience) override {
    char* topic = nullptr;
    int topic_bytes = 0;
    MQTTClient_message* message = nullptr;
    const int code = MQTTClient_receive(client_, &topic, &topic_bytes, &message,
                                        static_cast<unsigned long>(patience.count()));
    const bool is_good = code == MQTTCLIENT_SUCCESS || code == MQTTCLIENT_TOPICNAME_TRUNCATED;
    Fed fed;
    if (message != nullptr) {
      fed = taken(*message, into);
      MQTTClient_freeMessage(&message);
      MQTTClient_free(topic);
    } else if (!is_good || MQTTClient_isConnected(client_) == 0) {
      return failed("the connection", std::string(not_again));
    }
    return fed;
  }

  std::vector<Note> take_notes() override { return std::exchange(notes_, {}); }

 private:
  Error failed(const std::string& what, const std::string& why) const {
    return {Errc::device, fmt::format("{}:{}: {}: {}", place_.host, place_.port, what, why)};
  }

  Fed taken(const MQTTClient_message& message, std::span<char> into) {
    // A message retained by the broker is old, not a current sample.
    if (message.retained != 0) {
      notes_.push_back({Severity::info, "a message that the broker had kept is left out"});
      return {};
    }
    const auto bytes = static_cast<std::size_t>(std::max(message.payloadlen, 0));
    if (bytes > into.size()) {
      notes_.push_back(
          {Severity::warning, fmt::format("a message of {} bytes is left out: expected {} at most",
                                          bytes, into.size())});
      return {};
    }
    std::memcpy(into.data(), message.payload, bytes);
    return {bytes, false, 0};
  }

  MqttPlace place_;
  MQTTClient client_ = nullptr;
  std::vector<Note> notes_;
};

Result<MqttPlace> place_of(SourceUri& uri) {
  const std::string& text = uri.place();
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || slash + 1 == text.size())
    return Error{Errc::invalid_argument, "expected a broker and a topic, as in mqtt://HOST/TOPIC"};
  const auto at = parse_host_port(std::string_view(text).substr(0, slash));
  if (!at) return at.error();
  MqttPlace place{.host = at->host, .topic = text.substr(slash + 1)};
  if (place.topic.find_first_of("+#") != std::string::npos)
    return Error{
        Errc::invalid_argument,
        fmt::format("{}: one recording is of one topic: name it without + and #", place.topic)};
  if (at->port) place.port = *at->port;
  place.user = uri.value("user");
  place.password = uri.value("password");
  return place;
}

}  // namespace

Result<std::unique_ptr<Source>> open_mqtt(SourceUri& uri, const OpenOptions& options) {
  const auto place = place_of(uri);
  if (!place) return place.error();
  const auto framing = framing_options(uri, Carrier::datagrams);
  if (!framing) return framing.error();
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  auto feed = std::make_unique<MqttFeed>(*place);
  if (const Status connected = feed->connect(options.patience); !connected)
    return connected.error();
  SourceHead head;
  head.recording.source = shown_uri(uri.text());
  head.recording.format = "MQTT";
  head.settings.emplace_back("broker", fmt::format("{} port {}", place->host, place->port));
  head.settings.emplace_back("topic", place->topic);
  return open_stream(std::move(feed), *framing, std::move(head), options);
}

}  // namespace proofmass::acquire
