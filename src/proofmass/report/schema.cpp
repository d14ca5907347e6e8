#include "proofmass/report/schema.hpp"

#include <algorithm>
#include <optional>

#include "proofmass/core/contract.hpp"

namespace proofmass::report {
namespace {

using Kind = Shape::Kind;
/// The same entry in several samples.
using Samples = std::vector<const Field*>;

Object schema_of(const Samples& samples);

bool is_nullable(const Samples& samples) {
  return std::ranges::any_of(
      samples, [](const Field* field) { return field->shape.nullable || is_absent(*field); });
}

// "number", or ["number", "null"].
Value type_of(const char* name, const Samples& samples) {
  if (!is_nullable(samples)) return name;
  return Array{name, "null"};
}

// The entries of objects by key, in order of first appearance.
struct KeySamples {
  std::string key;
  Samples samples;
};

std::vector<KeySamples> by_key(const std::vector<const Fields*>& objects) {
  std::vector<KeySamples> keys;
  for (const Fields* fields : objects)
    for (const Field& field : *fields) {
      auto at = std::ranges::find(keys, field.key, &KeySamples::key);
      if (at == keys.end()) at = keys.insert(keys.end(), {field.key, {}});
      at->samples.push_back(&field);
    }
  return keys;
}

// Value of the choice on which the other entries depend.
const std::string& word_in(const Fields& object, const std::string& key) {
  return std::get<std::string>(std::ranges::find(object, key, &Field::key)->scalar.state());
}

// Keys that all objects with this word have and that not all objects have.
Object condition(const std::string& key,
                 const std::string& word,
                 const std::vector<const Fields*>& objects) {
  std::vector<const Fields*> with_word;
  std::ranges::copy_if(objects, std::back_inserter(with_word),
                       [&](const Fields* one) { return word_in(*one, key) == word; });
  const std::vector<KeySamples> all = by_key(objects);
  Array required;
  for (const KeySamples& one : by_key(with_word)) {
    const bool everywhere =
        std::ranges::find(all, one.key, &KeySamples::key)->samples.size() == objects.size();
    if (one.samples.size() == with_word.size() && !everywhere) required.push_back(one.key);
  }
  return {{"if", Object{{"properties", Object{{key, Object{{"const", word}}}}}}},
          {"then", Object{{"required", std::move(required)}}}};
}

// One condition for each word that occurs in the samples.
void add_conditions(Object& schema, const std::vector<const Fields*>& objects) {
  if (objects.empty()) return;
  const auto found = std::ranges::find_if(*objects.front(),
                                          [](const Field& field) { return field.shape.decides; });
  if (found == objects.front()->end()) return;
  Array conditions;
  std::vector<std::string> words;
  for (const Fields* object : objects) {
    const std::string& word = word_in(*object, found->key);
    if (std::ranges::find(words, word) != words.end()) continue;
    words.push_back(word);
    conditions.emplace_back(condition(found->key, word, objects));
  }
  schema.push_back({"allOf", std::move(conditions)});
}

// "properties" and "required".
void add_entries(Object& schema, Object properties, const std::vector<const Fields*>& objects) {
  Array required;
  for (const Member& given : properties) required.push_back(given.key);
  for (const KeySamples& one : by_key(objects)) {
    properties.push_back({one.key, schema_of(one.samples)});
    if (one.samples.size() == objects.size()) required.push_back(one.key);
  }
  schema.push_back({"properties", std::move(properties)});
  schema.push_back({"required", std::move(required)});
  add_conditions(schema, objects);
}

// The same, with no other properties allowed.
void add_properties(Object& schema, Object properties, const std::vector<const Fields*>& objects) {
  add_entries(schema, std::move(properties), objects);
  schema.push_back({"additionalProperties", false});
}

// The unit of a quantity if all samples agree; an absent value may have none.
std::optional<std::string> only_unit(const Samples& samples) {
  std::optional<std::string> unit;
  for (const Field* field : samples) {
    if (field->shape.unit.empty() && is_absent(*field)) continue;
    if (unit && *unit != field->shape.unit) return std::nullopt;
    unit = field->shape.unit;
  }
  return unit;
}

// Entries of the lists or maps, at least one.
Samples entries_of(const Samples& samples) {
  Samples entries;
  for (const Field* field : samples)
    if (field->fields)
      for (const Field& entry : *field->fields) entries.push_back(&entry);
  PM_EXPECTS(!entries.empty());
  return entries;
}

void add_items(Object& schema, const Samples& samples) {
  const std::optional<std::size_t>& length = samples.front()->shape.length;
  const bool is_fixed = length && std::ranges::all_of(samples, [&](const Field* field) {
                          return field->shape.length == length;
                        });
  if (is_fixed) {
    schema.push_back({"minItems", std::uint64_t{*length}});
    schema.push_back({"maxItems", std::uint64_t{*length}});
  }
  if (samples.front()->shape.of_texts) {
    schema.push_back({"items", Object{{"type", "string"}}});
    return;
  }
  schema.push_back({"items", schema_of(entries_of(samples))});
}

// {"value", "std", "unit"}
Object figure_schema(Value std_type, Object unit) {
  return {{"type", "object"},
          {"properties", Object{{"value", Object{{"type", "number"}}},
                                {"std", Object{{"type", std::move(std_type)}, {"minimum", 0}}},
                                {"unit", std::move(unit)}}},
          {"required", Array{"value", "std", "unit"}},
          {"additionalProperties", false}};
}

void add_quantity(Object& schema, const Samples& samples) {
  const std::optional<std::string> unit = only_unit(samples);
  const Object unit_schema = unit ? Object{{"const", *unit}} : Object{{"type", "string"}};
  if (samples.front()->shape.std_nullable) {
    schema.push_back({"anyOf", Array{Object{{"type", "null"}},
                                     figure_schema(Array{"number", "null"}, unit_schema)}});
    return;
  }
  schema.push_back({"$ref", "#/$defs/quantity"});
  if (unit) schema.push_back({"properties", Object{{"unit", unit_schema}}});
}

std::vector<const Fields*> objects_of(const Samples& samples) {
  std::vector<const Fields*> objects;
  for (const Field* field : samples)
    if (field->fields) objects.push_back(&*field->fields);
  return objects;
}

void add_bounds(Object& schema, const Shape& shape) {
  if (shape.not_negative || shape.kind == Kind::count) schema.push_back({"minimum", 0});
  if (shape.maximum) schema.push_back({"maximum", *shape.maximum});
}

void add_shape(Object& schema, const Samples& samples) {
  const Shape& shape = samples.front()->shape;
  switch (shape.kind) {
    case Kind::text:
      schema.push_back({"type", type_of("string", samples)});
      if (!shape.pattern.empty()) schema.push_back({"pattern", shape.pattern});
      break;
    case Kind::choice: {
      Array choices = Array(shape.choices.begin(), shape.choices.end());
      if (is_nullable(samples)) choices.emplace_back();
      schema.push_back({"enum", std::move(choices)});
      break;
    }
    case Kind::flag:
      schema.push_back({"type", type_of("boolean", samples)});
      break;
    case Kind::count:
      schema.push_back({"type", type_of("integer", samples)});
      add_bounds(schema, shape);
      break;
    case Kind::integer:
      schema.push_back({"type", type_of("integer", samples)});
      break;
    case Kind::number:
      schema.push_back({"type", type_of("number", samples)});
      add_bounds(schema, shape);
      break;
    case Kind::quantity:
      add_quantity(schema, samples);
      break;
    case Kind::list:
      schema.push_back({"type", type_of("array", samples)});
      add_items(schema, samples);
      break;
    case Kind::map:
      schema.push_back({"type", "object"});
      if (!shape.pattern.empty())
        schema.push_back({"propertyNames", Object{{"pattern", shape.pattern}}});
      schema.push_back({"additionalProperties", schema_of(entries_of(samples))});
      break;
    case Kind::object:
      schema.push_back({"type", type_of("object", samples)});
      add_properties(schema, {}, objects_of(samples));
      break;
  }
}

Object schema_of(const Samples& samples) {
  Object schema;
  const auto meaning = std::ranges::find_if(
      samples, [](const Field* field) { return !field->about.meaning.empty(); });
  if (meaning != samples.end()) schema.push_back({"description", (*meaning)->about.meaning});
  add_shape(schema, samples);
  return schema;
}

Object typed(const char* type, const char* description) {
  return {{"type", type}, {"description", description}};
}

Object list_of_texts(const char* description) {
  return {{"type", "array"}, {"items", typed("string", description)}};
}

// Head of every document.
Object head(const std::string& verb) {
  Object version = typed("string", "version that wrote the document");
  version.push_back({"pattern", "^\\d+\\.\\d+\\.\\d+"});
  return {{"proofmass", std::move(version)},
          {"verb", Object{{"const", verb}}},
          {"input", list_of_texts("file as the user named it; - is standard input")},
          {"warnings", list_of_texts("a sentence; the reason of every null is among them")}};
}

// Provenance, which the program adds to every document that it writes.
Object provenance() {
  Object input{{"type", "object"},
               {"properties",
                Object{{"path", Object{{"type", "string"}}},
                       {"bytes", Object{{"type", "integer"}, {"minimum", 0}}},
                       {"sha256", Object{{"type", "string"}, {"pattern", "^[0-9a-f]{64}$"}}},
                       {"reason",
                        typed("string",
                              "why there is no checksum: standard input, or not a regular file")}}},
               {"required", Array{"path"}},
               {"additionalProperties", false}};
  Object options = typed("object", "flags given, on the command line or by --config");
  options.push_back({"additionalProperties", Object{{"type", "string"}}});
  Object properties{{"command", typed("string", "as it was typed")},
                    {"options", std::move(options)},
                    {"date", typed("string", "of the evaluation, UTC, ISO 8601")},
                    {"version", Object{{"type", "string"}}},
                    {"commit", typed("string", "of the source; empty where it is not known")},
                    {"host", Object{{"type", "string"}}},
                    {"inputs", Object{{"type", "array"}, {"items", std::move(input)}}}};
  Array required;
  for (const Member& property : properties) required.push_back(property.key);
  return {{"type", "object"},
          {"description", "what is needed to repeat the result"},
          {"properties", std::move(properties)},
          {"required", std::move(required)},
          {"additionalProperties", false}};
}

Object quantity_schema() {
  return {{"description", "a figure and its standard deviation, or null with a reason in warnings"},
          {"anyOf",
           Array{Object{{"type", "null"}}, figure_schema("number", Object{{"type", "string"}})}}};
}

// Head of a schema.
Object title(const std::string& description, const std::string& verb, const std::string& name) {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"$id", name + ".schema.json"},
          {"title", "proofmass " + verb + " --json"},
          {"description", description},
          {"type", "object"}};
}

// Properties of every document.
Object common_properties(const std::string& verb) {
  Object properties = head(verb);
  properties.push_back({"provenance", provenance()});
  return properties;
}

std::string text_of(Object schema) {
  schema.push_back({"$defs", Object{{"quantity", quantity_schema()}}});
  return json_text(schema) + '\n';
}

std::vector<const Fields*> fields_of(const std::vector<Document>& samples) {
  PM_EXPECTS(!samples.empty());
  std::vector<const Fields*> objects;
  for (const Document& sample : samples) objects.push_back(&sample.fields);
  return objects;
}

}  // namespace

std::string json_schema(const std::string& description,
                        const std::vector<Document>& samples,
                        const std::string& name) {
  const std::vector<const Fields*> objects = fields_of(samples);
  const std::string& verb = samples.front().page.verb;
  Object schema = title(description, verb, name.empty() ? verb : name);
  add_properties(schema, common_properties(verb), objects);
  return text_of(std::move(schema));
}

std::string json_schema_of_kinds(const std::string& description,
                                 const std::vector<std::vector<Document>>& kinds) {
  PM_EXPECTS(!kinds.empty());
  Array alternatives;
  for (const std::vector<Document>& samples : kinds) {
    Object alternative;
    add_entries(alternative, {}, fields_of(samples));
    alternatives.push_back(std::move(alternative));
  }
  const std::string& verb = kinds.front().front().page.verb;
  Object schema = title(description, verb, verb);
  add_entries(schema, common_properties(verb), {});
  schema.push_back({"anyOf", std::move(alternatives)});
  schema.push_back({"unevaluatedProperties", false});
  return text_of(std::move(schema));
}

}  // namespace proofmass::report
