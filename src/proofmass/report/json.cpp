#include "proofmass/report/json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "proofmass/core/version.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Value& value);

struct JsonOf {
  Json operator()(std::monostate) const { return nullptr; }
  Json operator()(const Array& items) const {
    Json json = Json::array();
    for (const Value& item : items) json.push_back(json_of(item));
    return json;
  }
  Json operator()(const Object& members) const {
    Json json = Json::object();
    for (const Member& member : members) json[member.key] = json_of(member.value);
    return json;
  }
  template <class Plain>
  Json operator()(const Plain& plain) const {
    return plain;
  }
};

Json json_of(const Value& value) {
  return std::visit(JsonOf{}, value.state());
}

}  // namespace

Value::Value() = default;
Value::Value(std::nullptr_t) {}
Value::Value(bool value) : state_(value) {}
Value::Value(int value) : state_(std::int64_t{value}) {}
Value::Value(std::int64_t value) : state_(value) {}
Value::Value(std::uint64_t value) : state_(value) {}
Value::Value(double value) {
  if (std::isfinite(value)) state_ = value;
}
Value::Value(const char* text) : state_(std::string(text)) {}
Value::Value(std::string text) : state_(std::move(text)) {}
Value::Value(std::string_view text) : state_(std::string(text)) {}
Value::Value(Array items) : state_(std::move(items)) {}
Value::Value(Object members) : state_(std::move(members)) {}
Value::Value(const Value& other) = default;
Value::Value(Value&& other) noexcept = default;
Value& Value::operator=(const Value& other) = default;
Value& Value::operator=(Value&& other) noexcept = default;
Value::~Value() = default;

std::string to_json(const DocumentHead& head, const Object& body) {
  Object document{{"proofmass", version()},
                  {"verb", head.verb},
                  {"input", array_of(head.input)},
                  {"warnings", array_of(head.warnings)}};
  document.insert(document.end(), body.begin(), body.end());
  return json_text(document) + '\n';
}

std::string json_text(const Value& value) {
  constexpr int indent = 2;
  return json_of(value).dump(indent, ' ', false, Json::error_handler_t::replace);
}

Value quantity(const std::optional<Uncertain>& figure, std::string_view unit) {
  if (!figure || !std::isfinite(figure->value) || !std::isfinite(figure->std)) return nullptr;
  return Object{{"value", figure->value}, {"std", figure->std}, {"unit", unit}};
}

std::optional<Uncertain> scaled(const std::optional<Uncertain>& figure, double factor) {
  if (!figure) return std::nullopt;
  return Uncertain{figure->value * factor, figure->std * std::abs(factor)};
}

std::vector<std::string> texts(const std::vector<Note>& notes, Severity least) {
  std::vector<std::string> found;
  for (const Note& note : notes) {
    if (note.severity >= least) found.push_back(with_flags(note));
  }
  return found;
}

}  // namespace proofmass::report
