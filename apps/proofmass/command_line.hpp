#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

// What the user asked for. No analysis begins before all of it has been read and found to make
// sense.
namespace proofmass::app {

/// Flags of every verb that reads recordings.
struct InputFlags {
  std::optional<double> rate_hz;
  std::string unit;
  std::vector<std::string> channels, variables;
  std::string time;
  std::optional<double> from_s, to_s;
  std::vector<std::string> sensors;
  std::optional<double> supply_v;
  std::optional<double> resample_hz, skew_s;
  std::string resample_method = "sinc";
  double memory_mb = 1024.0;  ///< of verbs that read larger tables a piece at a time
  std::optional<double> gravity_mps2, latitude_deg, height_m;
  /// How long the sensors had been on at the file's first sample; of verbs that know warm-up only.
  std::optional<double> since_switch_on_s;
};

class Invocation;

/// Flags of every verb.
struct OutputFlags {
  std::string json, report, output;
  bool quiet = false, verbose = false, strict = false;
  std::shared_ptr<Invocation> invocation{};  ///< where a document or a page was asked for
};

struct InspectCommand {
  std::vector<std::string> files;
  bool pyramid = false;
  InputFlags input;
  OutputFlags output;
};

struct ConvertCommand {
  std::string file;
  InputFlags input;
  OutputFlags output;
};

struct WheelCommand {
  std::vector<std::string> files;
  std::string spin_axis;
  std::optional<double> radius_m, radius_std_m, rim_radius_m, rolling_radius_m, bandwidth_hz,
      axle_tilt_std_deg;
  bool no_gyro = false;
  std::string rate_unit = "rad/s";
  InputFlags input;
  OutputFlags output;
};

struct NoiseCommand {
  std::vector<std::string> files;
  std::string statistic = "oadev", taus, data = "rate", noise_type = "auto";
  std::string temperature, update_sensor;
  double confidence = 0.683;
  std::optional<double> stop_ratio;
  bool exclude_events = false;
  InputFlags input;
  OutputFlags output;
};

struct DriftCommand {
  std::vector<std::string> files;
  std::string temperature, update_sensor, order = "time";
  std::optional<double> forecast_s;
  InputFlags input;
  OutputFlags output;
};

/// Positions of a turntable at rest; or, by a flag, a wheel that turns or the model equation alone.
struct CalibrateCommand {
  std::vector<std::string> files;
  std::string rests;  ///< --rests: list of intervals
  std::optional<double> shortest_rest_s;
  bool means = false, keep_suspects = false, six_position = false;
  std::optional<int> parameters;  ///< 6, 9 or 12
  std::optional<double> gravity_std_mps2, temperature_c, bias_stability_mg;
  double orthogonality_std_deg = 0.57, placement_std_deg = 1.0;
  std::vector<double> supplies_v;
  std::vector<std::string> type_b, validate;
  std::size_t monte_carlo = 200;  ///< draws; 0: no check
  std::string name, serial, date;
  std::string update_sensor;
  InputFlags input;
  OutputFlags output;
};

struct TumbleCommand {
  std::vector<std::string> files;
  std::string rests;               ///< --rests: list of intervals
  std::vector<double> angles_deg;  ///< --angles: of each rest of a recording, in its order
  std::optional<double> shortest_rest_s;
  std::string angle_channel;        ///< --angle: the column with the angle; empty: by its name
  std::string input_axis;           ///< --input-axis: channel whose axis is at gravity × sin
  std::vector<int> planes, mounts;  ///< --plane, --mount: of each file; empty: columns or 1 and 0
  /// --indexing-std, --drift-std, --bandwidth; absent: assumed, or found from the residuals
  std::optional<double> indexing_std_deg, drift_std_mps2, bandwidth_hz;
  std::optional<double> gravity_std_mps2;
  bool rotating = false;                  ///< --rotating: run_rotation()
  std::vector<std::string> coefficients;  ///< --coefficients: run_model_equation()
  std::string update_sensor;
  InputFlags input;
  OutputFlags output;
};

/// Accelerations; or, with `angle`, the angle that they gave and a gyroscope's rate.
struct TiltCommand {
  std::string file;
  std::string base = "auto", reads = "+g";
  std::vector<std::string> gyro;  ///< channels x, y, z; empty: found
  bool no_gyro = false;
  std::string angle, rate_channel;  ///< columns, by name or number
  std::string angle_unit = "rad", rate_unit = "rad/s";
  std::optional<double> shortest_rest_s, bias_std_mps2, gravity_std_mps2;
  InputFlags input;
  OutputFlags output;
};

/// Displacement of one accelerometer, or of several that are fused.
struct TrackCommand {
  std::string file;
  std::string model = "inertial";  ///< or pva, fused
  std::optional<double> jerk_psd_m2ps5;
  std::vector<std::string> gravity;  ///< a number in m/s^2, "removed" or "present", or both
  std::string axis;                  ///< empty: found
  bool same_place = false;
  double same_place_std_m = 1e-3;
  std::string fixes, still, turns;  ///< files: positions, intervals, times of velocity 0
  std::string rests = "found";
  double fix_std_m = 0.01;  ///< of fixes without their own
  std::optional<double> shortest_rest_s, scale_std;
  double rest_speed_std_mps = 1e-4;
  bool take_as_acceleration = false, no_gyro = false;
  std::string rate_unit = "rad/s";
  InputFlags input;
  OutputFlags output;
};

/// Q, R and the time constant of a bias from one recording.
struct TuneCommand {
  std::string file;
  std::string model = "auto";
  std::vector<std::string> fix, share;  ///< --fix NAME=VALUE, --share NAME
  bool from_sensor = false;             ///< start at the noise of the sensor file
  double study_step_s = 0.0;            ///< 0: the recording's own
  std::string update_sensor;
  InputFlags input;
  OutputFlags output;
};

struct SimulateCommand {
  std::string rig;  ///< the description: of the rig, or with --procedure of the procedure
  std::optional<std::uint64_t> seed;
  std::optional<double> rpm, rate_hz, duration_s, gravity_mps2;
  bool datasheet_errors = false, print_config = false;
  std::optional<int> adc_bits;
  std::string procedure, signal;  ///< empty: the rig; as the description says
  std::optional<std::uint64_t> session;
  std::optional<int> positions;
  std::optional<double> dwell_s, supply_v;
  std::optional<int> strokes, repetitions;  ///< of a slide
  std::optional<double> length_m, stroke_s, elevation_deg;
  bool gravity_removed = false, gyro = false;
  OutputFlags output;
};

struct BudgetCommand {
  std::vector<double> bias_mg, times_s;
  std::vector<std::string> sensors;
  OutputFlags output;
};

/// The thesis's programme, on the recordings that are named; the rest of it is simulated.
struct ThesisCommand {
  std::string still, tumble;        ///< --static, --tumble: files; empty: simulated
  std::vector<std::string> wheels;  ///< --wheel: one run at one speed each; empty: simulated
  std::vector<double> angles_deg;   ///< --angles: of the rests in `tumble`
  std::optional<double> radius_m;
  std::size_t runs = 50;      ///< simulated at each speed
  double static_hours = 2.0;  ///< of the simulated test at rest
  std::uint64_t seed = 1;
  InputFlags input;
  OutputFlags output;
};

/// Of `record`: a procedure that a person is led through, and what is made of it.
struct GuideFlags {
  std::string procedure;                 ///< tumble, multi-position or static; empty: none
  std::optional<std::size_t> positions;  ///< --positions
  std::optional<double> target_std_mg;   ///< --target-std
  std::optional<double> minutes;         ///< --minutes, of static
  std::string update_sensor;             ///< of the verb that follows
};

/// Live samples to disk; or, with `list`, what is there to record from.
struct RecordCommand {
  std::string source;
  bool list = false;
  std::optional<double> duration_s, rotate_s, rotate_mb;
  std::string trigger;  ///< "acc_x > 2"
  double trigger_before_s = 1.0, trigger_after_s = 1.0;
  bool reconnect = false;
  double stall_s = 2.0, stall_end_s = 30.0;
  std::string estimate;  ///< wheel, track or tilt; empty: none
  GuideFlags guide;
  std::optional<double> lag_s, radius_m, bandwidth_hz;
  std::string axis;  ///< of the wheel's axle, or of the motion
  InputFlags input;  ///< rate, unit, channels, sensors, supply and gravity
  OutputFlags output;
};

struct RecoverCommand {
  std::string file;
  OutputFlags output;
};

struct SensorCommand {
  std::string action, format, rostopic;
  std::vector<std::string> files;
  std::optional<double> rate_hz;
  OutputFlags output;
};

/// A verb for many recordings; or, with the verb "summary", what they show together.
struct FleetCommand {
  std::string verb;
  std::string manifest;            ///< a table or a folder of recordings; of summary the results
  std::vector<std::string> flags;  ///< the verb's, as they were typed
  std::string into;
  std::optional<std::size_t> processes;
  std::optional<double> memory_mb, timeout_s;
  bool force = false, reports = false;
  std::string shard;                ///< "2/4"; empty: by the environment
  std::string dask, program;        ///< the scheduler's address; the program's path on its workers
  std::string by;                   ///< column by which files of one sensor are one recording
  std::vector<std::string> limits;  ///< of summary: "white<2e-3"
  double false_share = 0.05;        ///< of summary: among the sensors that it calls out of family
  OutputFlags output;
};

using Command = std::variant<InspectCommand,
                             ConvertCommand,
                             WheelCommand,
                             NoiseCommand,
                             DriftCommand,
                             CalibrateCommand,
                             TumbleCommand,
                             TiltCommand,
                             TrackCommand,
                             TuneCommand,
                             SimulateCommand,
                             BudgetCommand,
                             RecordCommand,
                             RecoverCommand,
                             SensorCommand,
                             ThesisCommand,
                             FleetCommand>;

/// Reads the command line and the configuration file that it may name. --help and --version are
/// printed here, and have no command; nor has what a shell asks for at Tab. Throws Failure.
[[nodiscard]] std::optional<Command> parse_command_line(int argc, char** argv);

/// "x", "-z", "0,0.1,1" as a vector. Throws Failure (usage).
[[nodiscard]] std::array<double, 3> parse_axis(const std::string& text);

}  // namespace proofmass::app
