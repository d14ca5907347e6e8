#include "proofmass/sensor/parts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <numbers>
#include <string>

#include "proofmass/core/units.hpp"
#include "proofmass/sensor/datasheet.hpp"

namespace proofmass::sensor {
namespace {

constexpr double g = standard_gravity_mps2, mg = 1e-3 * g, ug = 1e-6 * g, deg = rad_per_deg;

constexpr PartFigure typ(double value) {
  return {value, FigureKind::typical};
}
constexpr PartFigure max(double value) {
  return {value, FigureKind::limit};
}

constexpr std::array accelerometers{
    AccelerometerPart{.name = "ADXL1002",
                      .maker = "Analog Devices",
                      .output = PartOutput::analog,
                      .document = "Analog Devices, ADXL1001/ADXL1002 datasheet rev. B",
                      .range_mps2 = 50.0 * g,
                      .noise_mps2_rthz = typ(25.0 * ug),
                      .nonlinearity = typ(0.001)},
    // The density is 22.5 µg/√Hz since revision B; it was 25 before.
    AccelerometerPart{
        .name = "ADXL355",
        .maker = "Analog Devices",
        .document = "Analog Devices, ADXL354/ADXL355 datasheet rev. B (2020), table 2",
        .range_mps2 = 2.048 * g,
        .noise_mps2_rthz = typ(22.5 * ug),
        .offset_mps2 = max(75.0 * mg),
        .offset_mps2_per_k = max(0.15 * mg),
        .scale = max(0.08),
        .scale_per_k = typ(1e-4),
        .nonlinearity = typ(0.001),
        .cross_axis = typ(0.01)},
    AccelerometerPart{.name = "ADXL357",
                      .maker = "Analog Devices",
                      .document = "Analog Devices, ADXL356/ADXL357 datasheet rev. A (2020), page 1",
                      .range_mps2 = 10.24 * g,
                      .noise_mps2_rthz = typ(75.0 * ug),
                      .offset_mps2_per_k = max(0.75 * mg)},
    AccelerometerPart{.name = "ADXL335",
                      .maker = "Analog Devices",
                      .output = PartOutput::analog,
                      .document = "Analog Devices, ADXL335 datasheet rev. B (2010), table 1",
                      .range_mps2 = *adxl335.full_scale_mps2.min,
                      .noise_mps2_rthz = typ(adxl335.noise_density_mps2_rthz[2]),
                      .offset_mps2 = max((*adxl335.zero_g_v[2].max - *adxl335.zero_g_v[2].typ) /
                                         *adxl335.sensitivity_v_per_mps2.typ),
                      .offset_mps2_per_k = typ(adxl335.bias_tempco_mps2_per_k),
                      .scale = max(0.1),
                      .scale_per_k = typ(adxl335.sensitivity_tempco_per_k),
                      .nonlinearity = typ(adxl335.nonlinearity),
                      .cross_axis = typ(adxl335.cross_axis)},
    // Noise is stated as 1.1 LSB rms at 100 Hz only.
    AccelerometerPart{.name = "ADXL345",
                      .maker = "Analog Devices",
                      .document = "Analog Devices, ADXL345 datasheet rev. E (2015), table 1",
                      .range_mps2 = 2.0 * g,
                      .offset_mps2 = max(250.0 * mg),
                      .offset_mps2_per_k = typ(1.2 * mg),
                      .scale_per_k = typ(1e-4),
                      .nonlinearity = typ(0.005),
                      .cross_axis = typ(0.01)},
    AccelerometerPart{.name = "BMI088",
                      .maker = "Bosch Sensortec",
                      .document = "Bosch Sensortec, BST-BMI088-DS001, revision 1.3 (2018), table 2",
                      .range_mps2 = 3.0 * g,
                      .noise_mps2_rthz = typ(190.0 * ug),
                      .offset_mps2 = typ(20.0 * mg),
                      .offset_mps2_per_k = typ(0.2 * mg),
                      .scale_per_k = typ(2e-5),
                      .nonlinearity = typ(0.005)},
    AccelerometerPart{.name = "BMI160",
                      .maker = "Bosch Sensortec",
                      .document = "Bosch Sensortec, BST-BMI160-DS000, revision 0.8 (2015), table 2",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(180.0 * ug),
                      .offset_mps2 = typ(40.0 * mg),
                      .offset_mps2_per_k = typ(1.0 * mg),
                      .scale_per_k = typ(3e-4),
                      .nonlinearity = typ(0.005),
                      .cross_axis = typ(0.01)},
    AccelerometerPart{.name = "MS1002",
                      .maker = "Safran Colibrys",
                      .output = PartOutput::analog,
                      .document = "Safran Colibrys, MS1000 datasheet, 2016-12-30",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(7.0 * ug),
                      .in_run_mps2 = typ(3.0 * ug),
                      .repeatability_mps2 = typ(0.24 * mg),
                      .nonlinearity = typ(0.003)},
    AccelerometerPart{.name = "MS1010",
                      .maker = "Safran Colibrys",
                      .output = PartOutput::analog,
                      .document = "Safran Colibrys, MS1000 datasheet, 2016-12-30",
                      .range_mps2 = 10.0 * g,
                      .noise_mps2_rthz = typ(34.0 * ug),
                      .in_run_mps2 = typ(15.0 * ug),
                      .repeatability_mps2 = typ(1.2 * mg),
                      .nonlinearity = typ(0.003)},
    AccelerometerPart{.name = "MPU-6050",
                      .maker = "TDK InvenSense",
                      .document = "InvenSense, PS-MPU-6000A-00 revision 3.4 (2013), section 6.2",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(400.0 * ug),
                      .offset_mps2 = typ(80.0 * mg),
                      .scale = typ(0.03),
                      .scale_per_k = typ(2e-4),
                      .nonlinearity = typ(0.005),
                      .cross_axis = typ(0.02)},
    AccelerometerPart{.name = "MPU-9250",
                      .maker = "TDK InvenSense",
                      .document = "InvenSense, PS-MPU-9250A-01 revision 1.1 (2016), table 2",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(300.0 * ug),
                      .offset_mps2 = typ(80.0 * mg),
                      .offset_mps2_per_k = typ(1.5 * mg),
                      .scale = typ(0.03),
                      .scale_per_k = typ(2.6e-4),
                      .nonlinearity = typ(0.005),
                      .cross_axis = typ(0.02)},
    AccelerometerPart{.name = "SCA3300-D01",
                      .maker = "Murata",
                      .document = "Murata, SCA3300-D01 datasheet, document 3165 rev. 2, page 1",
                      .range_mps2 = 1.5 * g,
                      .noise_mps2_rthz = typ(37.0 * ug)},
    AccelerometerPart{.name = "MMA8451Q",
                      .maker = "NXP",
                      .document = "NXP, MMA8451Q data sheet, table 2 (normal mode)",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(126.0 * ug),
                      .offset_mps2 = typ(17.0 * mg),
                      .offset_mps2_per_k = typ(0.15 * mg),
                      .scale = typ(0.0264),
                      .scale_per_k = typ(8e-5)},
    AccelerometerPart{.name = "LIS3DH",
                      .maker = "STMicroelectronics",
                      .document = "STMicroelectronics, LIS3DH, DocID17530 rev. 2, table 4",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(220.0 * ug),
                      .offset_mps2 = typ(40.0 * mg),
                      .offset_mps2_per_k = typ(0.5 * mg),
                      .scale_per_k = typ(1e-4)},
    AccelerometerPart{.name = "LSM6DSO",
                      .maker = "STMicroelectronics",
                      .document = "STMicroelectronics, LSM6DSO, DS12140 rev. 2, table 2",
                      .range_mps2 = 2.0 * g,
                      .noise_mps2_rthz = typ(70.0 * ug),
                      .offset_mps2 = typ(20.0 * mg),
                      .offset_mps2_per_k = typ(0.1 * mg),
                      .scale = typ(0.01),
                      .scale_per_k = typ(1e-4)},
};

constexpr std::array gyroscopes{
    GyroscopePart{.name = "BMI088",
                  .maker = "Bosch Sensortec",
                  .document = "Bosch Sensortec, BST-BMI088-DS001, revision 1.3 (2018), table 3",
                  .range_radps = 2000.0 * deg,
                  .noise_radps_rthz = typ(0.014 * deg),
                  .offset_radps = typ(1.0 * deg),
                  .offset_radps_per_k = typ(0.015 * deg)},
    GyroscopePart{.name = "BMI160",
                  .maker = "Bosch Sensortec",
                  .document = "Bosch Sensortec, BST-BMI160-DS000, revision 0.8 (2015), table 3",
                  .range_radps = 2000.0 * deg,
                  .noise_radps_rthz = typ(0.007 * deg),
                  .offset_radps = typ(3.0 * deg),
                  .offset_radps_per_k = typ(0.05 * deg)},
    GyroscopePart{.name = "LSM6DSO",
                  .maker = "STMicroelectronics",
                  .document = "STMicroelectronics, LSM6DSO, DS12140 rev. 2, table 2",
                  .range_radps = 2000.0 * deg,
                  .noise_radps_rthz = typ(0.0038 * deg),
                  .offset_radps = typ(1.0 * deg),
                  .offset_radps_per_k = typ(0.010 * deg),
                  .scale = typ(0.01)},
    GyroscopePart{.name = "MPU-6050",
                  .maker = "TDK InvenSense",
                  .document = "InvenSense, PS-MPU-6000A-00 revision 3.4 (2013), section 6.1",
                  .range_radps = 2000.0 * deg,
                  .noise_radps_rthz = typ(mpu6050.noise_density_radps_rthz),
                  .offset_radps = typ(mpu6050.zero_rate_radps),
                  .scale = max(mpu6050.scale_tolerance),
                  .nonlinearity = typ(0.002),
                  .cross_axis = typ(mpu6050.cross_axis),
                  .g_sensitivity_radps_per_mps2 = typ(mpu6050.g_sensitivity_radps_per_mps2)},
    GyroscopePart{.name = "MPU-9250",
                  .maker = "TDK InvenSense",
                  .document = "InvenSense, PS-MPU-9250A-01 revision 1.1 (2016), table 1",
                  .range_radps = 2000.0 * deg,
                  .noise_radps_rthz = typ(0.01 * deg),
                  .offset_radps = typ(5.0 * deg),
                  .scale = typ(0.03),
                  .nonlinearity = typ(0.001),
                  .cross_axis = typ(0.02)},
};

std::string plain(std::string_view name) {
  std::string out;
  for (const char c : name)
    if (c != '-' && c != ' ')
      out.push_back(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
  return out;
}

}  // namespace

double PartFigure::std() const {
  return kind == FigureKind::typical ? value : value / std::numbers::sqrt3;
}

View<AccelerometerPart> accelerometer_parts() {
  return accelerometers;
}

const AccelerometerPart* find_part(std::string_view name) {
  const auto found = std::ranges::find_if(accelerometers, [&](const AccelerometerPart& part) {
    return plain(part.name) == plain(name);
  });
  return found == accelerometers.end() ? nullptr : &*found;
}

View<GyroscopePart> gyroscope_parts() {
  return gyroscopes;
}

}  // namespace proofmass::sensor
