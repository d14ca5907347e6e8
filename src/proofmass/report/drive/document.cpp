#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <optional>
#include <string>
#include <string_view>

#include "proofmass/core/units.hpp"
#include "proofmass/report/drive/report.hpp"
#include "proofmass/report/wording.hpp"

namespace proofmass::report {
namespace {

using estimate::DriveSolution;
using estimate::DriveWheelFit;

constexpr Display in_degrees{"°", deg_per_rad}, in_milliseconds{"ms", 1e3};

std::string path_words(const DriveSolution& solution) {
  const std::string turned = degree_words(solution.heading_change_rad);
  std::string words;
  if (solution.distance_m && solution.heading_change_rad)
    words = fmt::format("The vehicle travelled {} and turned by {}",
                        with_std(*solution.distance_m, "m"), turned);
  else if (solution.distance_m)
    words = fmt::format("The vehicle travelled {}; its heading is not observable",
                        with_std(*solution.distance_m, "m"));
  else if (solution.heading_change_rad)
    words = fmt::format("The vehicle turned by {}; the distance is not determined", turned);
  else
    words = "Neither distance nor heading is determined";
  if (solution.closure_m)
    words += fmt::format("; it ended {} from the start", with_std(*solution.closure_m, "m"));
  return words + ".";
}

// The sentence of `not_observable` that begins so.
std::string reason(const DriveSolution& solution, std::string_view begins) {
  for (const std::string& sentence : solution.not_observable)
    if (sentence.starts_with(begins)) return sentence;
  return "not determined by these recordings";
}

std::string end_reason(const DriveSolution& solution) {
  return solution.distance_m ? reason(solution, "end position") : reason(solution, "distance");
}

Fields drive_wheel_fields(const DriveSolution& solution, const DriveWheelFit& wheel) {
  return {
      field::text("file", wheel.name, {.label = "Wheel"}),
      field::choice("side", wheel.side == estimate::VehicleSide::right ? "right" : "left",
                    {"right", "left"}, {.label = "Side"}),
      field::flag("steered", wheel.steered, {.meaning = "on the steered axle", .label = "Steered"}),
      field::measured("turns", wheel.turns, "turn",
                      {.meaning = "over its own recording, forwards positive",
                       .label = "Turns",
                       .display = Display{}}),
      field::measured("circumference_m", wheel.circumference_m, "m",
                      {.meaning = "rolling",
                       .label = "Rolling circumference",
                       .why_null = reason(solution, "distance")}),
      field::flag("gyroscope", wheel.has_yaw, {.meaning = "it gave the vehicle's yaw rate"}),
      field::magnitude("spin_tilt_rad", wheel.spin_tilt_rad,
                       {.meaning = "of the axle against the gyroscope's nearest axis, removed",
                        .label = "Tilt of the spin axis",
                        .display = in_degrees})};
}

Fields clock_offsets(const DriveSolution& solution) {
  Fields items;
  const auto add = [&](const std::string& name, const std::optional<Uncertain>& offset) {
    items.push_back(field::measured(
        {}, offset, "s", {.label = "Clock of " + file_name(name), .display = in_milliseconds}));
  };
  for (const DriveWheelFit& wheel : solution.wheels) add(wheel.name, wheel.clock_offset_s);
  if (solution.frame_clock_offset_s) add("frame", solution.frame_clock_offset_s);
  if (solution.fixes) add(solution.fixes->name, solution.fixes->clock_offset_s);
  return items;
}

Field fixes_field(const DriveSolution& solution) {
  std::optional<Fields> fields;
  if (const auto& fixes = solution.fixes) {
    fields = Fields{
        field::text("file", fixes->name),
        field::count("fixes", fixes->fixes, {.meaning = "distinct", .label = "Position fixes"}),
        field::count("used", fixes->used, {.meaning = "within the recordings and the gate"}),
        field::magnitude("time_scale", fixes->time_scale,
                         {.meaning = "seconds for each second of its stamps"}),
        field::magnitude("noise_m", fixes->noise_m,
                         {.meaning = "white part of the error, standard deviation of an axis",
                          .label = "Noise of a fix",
                          .display = Display{"m"}}),
        field::magnitude("wander_m", fixes->wander_m,
                         {.meaning = "slowly varying part, standard deviation of an axis",
                          .label = "Wander of the fixes",
                          .display = Display{"m"}}),
        field::magnitude("wander_s", fixes->wander_s, {.meaning = "its correlation time"}),
        field::magnitude("path_m", fixes->path_m,
                         {.meaning = "length of the line through the fixes, noise included"})};
  }
  return field::object_or_null("gnss", std::move(fields), {.why_null = "no position fixes used"});
}

Field end_field(const DriveSolution& solution) {
  Fields items;
  const bool east = solution.has_fixes;
  const std::array<const char*, 2> labels{east ? "End, east" : "End, ahead",
                                          east ? "End, north" : "End, to the left"};
  for (std::size_t i = 0; i < 2; ++i)
    items.push_back(field::measured({}, solution.end_m[i], "m",
                                    {.label = labels[i], .why_null = end_reason(solution)}));
  return field::fixed_list("end_m", std::move(items),
                           {.meaning = "from the start: east and north with fixes, else ahead and "
                                       "to the left of the vehicle at the start"});
}

std::optional<Uncertain> share_percent(const std::optional<Uncertain>& part,
                                       const std::optional<Uncertain>& whole) {
  if (!part || !whole || !(whole->value > 0.0)) return std::nullopt;
  return Uncertain{100.0 * part->value / whole->value, 100.0 * part->std / whole->value};
}

Fields motion_fields(const DriveSolution& solution) {
  const std::optional<Uncertain>& distance = solution.distance_m;
  return {
      field::measured("distance_m", distance, "m",
                      {.meaning = "path length of the reference point",
                       .label = "Distance",
                       .why_null = reason(solution, "distance")}),
      field::number(
          "distance_std_percent",
          distance && distance->value > 0.0 ? std::optional(100.0 * distance->std / distance->value)
                                            : std::nullopt,
          {.why_null = distance ? "the vehicle did not move" : reason(solution, "distance")}),
      field::measured("heading_change_rad", solution.heading_change_rad, "rad",
                      {.meaning = "end minus start, a left turn positive",
                       .label = "Heading change",
                       .why_null = reason(solution, "heading"),
                       .display = in_degrees}),
      field::measured("heading_start_rad", solution.heading_start_rad, "rad",
                      {.meaning = "from east, counter-clockwise",
                       .label = "Heading at the start",
                       .why_null = solution.has_fixes
                                       ? "the fixes do not determine it: the vehicle hardly moved"
                                       : reason(solution, "absolute"),
                       .display = in_degrees}),
      end_field(solution),
      field::measured("closure_m", solution.closure_m, "m",
                      {.meaning = "distance of the end from the start",
                       .label = "Closure",
                       .why_null = end_reason(solution)}),
      field::measured(
          "closure_percent", share_percent(solution.closure_m, distance), "%",
          {.meaning = "closure in percent of the distance", .why_null = end_reason(solution)})};
}

Fields drive_fields(const DriveReport& report) {
  const DriveSolution& solution = report.solution;
  Fields fields = motion_fields(solution);
  append(fields,
         {field::text("reference_point", solution.reference_point,
                      {.meaning = "whose path it is", .label = "Reference point"}),
          field::records(
              "wheels", solution.wheels,
              [&](const DriveWheelFit& wheel) { return drive_wheel_fields(solution, wheel); }),
          field::measured("track_m", solution.track_m, "m",
                          {.label = "Track width",
                           .why_null = "neither given nor determined by the wheels of both sides"}),
          field::measured("wheelbase_m", solution.wheelbase_m, "m",
                          {.label = "Wheelbase", .why_null = "no wheel of a steered axle"}),
          field::list("clock_offsets_s", clock_offsets(solution),
                      {.meaning = "of the wheels, the frame and the fixes: time since the file's "
                                  "first sample, minus the same of the first wheel"}),
          fixes_field(solution),
          field::magnitude("slip_m_per_rtm", solution.slip_m_per_rtm,
                           {.meaning = "random walk of a wheel's rolled distance"}),
          field::magnitude("nis", solution.nis,
                           {.meaning = "mean normalised innovation squared, 1 expected"}),
          field::texts("not_observable", solution.not_observable,
                       {.meaning = "what the recordings do not determine, and what would"}),
          field::notes(all_notes(report.notes, solution.notes))});
  return fields;
}

Section drive_method() {
  return {
      .heading = "How it was computed",
      .paragraphs = {
          "The angle of each wheel is that of gravity in its accelerometer, which rotates once "
          "with each turn, or an encoder's. The gyroscope's axes in the plane of the wheel, "
          "rotated "
          "by this angle, give the yaw rate; the part of the spin that the tilted axle projects on "
          "them is removed by regression. A planar extended Kalman filter and smoother combines "
          "them with the position fixes.",
          "Rolling circumferences, track width, gyroscope scales and clock offsets are constants "
          "with priors. Slip is a random walk of each wheel's rolled distance. The error of the "
          "fixes is white noise and a slow wander, both estimated, so that a wander is not "
          "followed. Standard deviations are those of the smoother."}};
}

}  // namespace

Document describe(const DriveReport& report) {
  const DriveSolution& solution = report.solution;
  Document document{.page = {.verb = "drive",
                             .title = file_names(report.inputs),
                             .inputs = report.inputs,
                             .conclusion = path_words(solution),
                             .notes = all_notes(report.notes, solution.notes)},
                    .fields = drive_fields(report),
                    .warnings = solution.not_observable};
  Page& page = document.page;
  page.key_figures = key_figures(document.fields);
  if (!solution.series.x_m.empty())
    page.sections.push_back({.heading = "Path",
                             .figures = {[&] { return path_figure(solution); },
                                         [&] { return heading_figure(solution); },
                                         [&] { return drive_speed_figure(solution); }}});
  const auto wheels = std::ranges::find(document.fields, "wheels", &Field::key);
  page.sections.push_back({.heading = "The wheels",
                           .tables = {records_table("Each wheel", *wheels)},
                           .on_terminal = true});
  if (!solution.not_observable.empty())
    page.sections.push_back({.heading = "Not identifiable from these recordings",
                             .points = solution.not_observable,
                             .on_terminal = true});
  page.sections.push_back(drive_method());
  return document;
}

}  // namespace proofmass::report
