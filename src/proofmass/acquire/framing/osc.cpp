#include <bit>
#include <cstdint>
#include <string>

#include "proofmass/acquire/framing/keys.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::string_view bundle_mark{"#bundle\0", 8};
constexpr int deepest = 4;

/// The remainder of a packet; reading beyond its end marks it as bad.
class OscBytes {
 public:
  explicit OscBytes(std::string_view bytes) : rest_(bytes) {}
  [[nodiscard]] bool is_bad() const { return is_bad_; }
  [[nodiscard]] bool empty() const { return rest_.empty(); }

  std::string_view take(std::size_t bytes) {
    if (bytes > rest_.size()) {
      is_bad_ = true;
      rest_ = {};
      return {};
    }
    const std::string_view taken = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return taken;
  }
  /// Most significant byte first.
  std::uint64_t number(std::size_t bytes) {
    std::uint64_t value = 0;
    for (const char c : take(bytes)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
  }
  /// Terminated by a zero and padded with zeros to a multiple of four.
  std::string_view text() {
    const std::size_t end = rest_.find('\0');
    if (end == std::string_view::npos) return take(rest_.size() + 1);
    return take((end + 4) / 4 * 4).substr(0, end);
  }
  void blob() {
    const std::uint64_t bytes = number(4);
    (void)take(bytes > rest_.size() ? rest_.size() + 1 : (bytes + 3) / 4 * 4);
  }

 private:
  std::string_view rest_;
  bool is_bad_ = false;
};

bool is_figure(char type) {
  return std::string_view("ifhdTF").find(type) != std::string_view::npos;
}

struct OscFigure {
  double value = 0.0;
  std::optional<Tick> exact{};
};

OscFigure read_figure(OscBytes& bytes, char type) {
  const auto whole = [](std::int64_t value) {
    return OscFigure{static_cast<double>(value), Tick{value, 0}};
  };
  if (type == 'T' || type == 'F') return whole(type == 'T' ? 1 : 0);
  if (type == 'i') return whole(static_cast<std::int32_t>(bytes.number(4)));
  if (type == 'h') return whole(static_cast<std::int64_t>(bytes.number(8)));
  const double value =
      type == 'd'
          ? std::bit_cast<double>(bytes.number(8))
          : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bytes.number(4))));
  return {value, tick_of(value)};
}

/// Skips an argument that is not a number; false if its type, and thus its length, is unknown.
bool skip_other(OscBytes& bytes, char type) {
  if (type == 's' || type == 'S') {
    (void)bytes.text();
  } else if (type == 'b') {
    bytes.blob();
  } else if (type == 'c' || type == 'r' || type == 'm') {
    (void)bytes.take(4);
  } else if (type == 't') {
    (void)bytes.take(8);
  } else {
    return type == 'N' || type == 'I' || type == '[' || type == ']';
  }
  return true;
}

/// "/gyrosc/accel" is "gyrosc.accel".
std::string name_of(std::string_view address) {
  std::string name(address.substr(1));
  for (char& c : name)
    if (c == '/') c = '.';
  return name;
}

bool visit_message(OscBytes bytes, const KeyVisit& visit) {
  const std::string_view address = bytes.text();
  const std::string_view types = bytes.text();
  if (bytes.is_bad() || address.size() < 2 || !types.starts_with(',')) return false;
  std::size_t figures = 0;
  for (const char type : types) figures += is_figure(type) ? 1 : 0;
  const std::string name = name_of(address);
  std::size_t next = 0;
  for (const char type : types.substr(1)) {
    if (!is_figure(type)) {
      if (!skip_other(bytes, type)) return false;
      continue;
    }
    const OscFigure figure = read_figure(bytes, type);
    if (bytes.is_bad()) return false;
    visit(figures == 1 ? name : name + '.' + std::to_string(next++), figure.value, figure.exact);
  }
  return !bytes.is_bad();
}

bool visit_packet(std::string_view packet, const KeyVisit& visit, int level) {
  if (!packet.starts_with(bundle_mark))
    return is_osc(packet) && visit_message(OscBytes(packet), visit);
  if (level == deepest) return false;
  OscBytes bytes(packet.substr(bundle_mark.size()));
  (void)bytes.take(8);  // its time, which most senders set to "immediately"
  while (!bytes.empty()) {
    const std::string_view element = bytes.take(bytes.number(4));
    if (bytes.is_bad() || !visit_packet(element, visit, level + 1)) return false;
  }
  return !bytes.is_bad();
}

}  // namespace

bool is_osc(std::string_view packet) {
  return packet.starts_with(bundle_mark) ||
         (packet.size() >= 8 && packet.size() % 4 == 0 && packet.starts_with('/') &&
          packet.find('\0') != std::string_view::npos);
}

bool visit_osc(std::string_view packet, const KeyVisit& visit) {
  return visit_packet(packet, visit, 0);
}

}  // namespace proofmass::acquire
