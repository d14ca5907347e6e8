#include "proofmass/simulate/rig_file.hpp"

#include "proofmass/simulate/rig/description.hpp"
#include "proofmass/simulate/rig/fields.hpp"

namespace proofmass::simulate {
namespace {

using description::must_be_empty;
using description::Print;
using description::read_list;
using description::read_section;
using description::Take;

RigOptions read_options(toml::table& root) {
  RigOptions o;
  visit_general(o, Take{root});
  read_section(root, "wheel", [&](Take take) { visit_wheel(o.wheel, take); });
  read_section(root, "ripple", [&](Take take) { visit_ripple(o.wheel.ripple, take); });
  read_section(root, "supply", [&](Take take) { visit_supply(o.supply, take); });
  read_section(root, "daq", [&](Take take) { visit_daq(o.daq, take); });
  read_list(root, "segment", o.wheel.profile,
            [](SpeedSegment& segment, Take take) { visit_segment(segment, take); });
  read_list(root, "sensor", o.sensors,
            [](RigSensor& sensor, Take take) { visit_sensor(sensor, take); });
  must_be_empty(root, "a rig's description");
  return o;
}

}  // namespace

Result<RigOptions> parse_rig_file(std::string_view text, std::string_view name) {
  return description::parse<RigOptions>(text, name, read_options);
}

Result<RigOptions> read_rig_file(const std::string& path) {
  const Result<std::string> text = description::text_of(path, "a rig's description");
  if (!text) return text.error();
  return parse_rig_file(*text, path);
}

std::string format_rig_file(const RigOptions& options) {
  std::string out =
      "# A rig for `proofmass simulate`. A key that is left out keeps its default.\n\n";
  const Print print{out};
  visit_general(options, print);
  out += "\n[wheel]\n";
  visit_wheel(options.wheel, print);
  out += "\n[ripple]\n";
  visit_ripple(options.wheel.ripple, print);
  out += "\n[supply]\n";
  visit_supply(options.supply, print);
  out += "\n[daq]\n";
  visit_daq(options.daq, print);
  for (const SpeedSegment& segment : options.wheel.profile) {
    out += "\n[[segment]]\n";
    visit_segment(segment, print);
  }
  for (const RigSensor& sensor : options.sensors) {
    out += "\n[[sensor]]\n";
    visit_sensor(sensor, print);
  }
  return out;
}

}  // namespace proofmass::simulate
