#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "proofmass/core/result.hpp"

// NI-DAQmx: National Instruments' driver for its cards, loaded on demand.
// Source: National Instruments, "NI-DAQmx C Reference Help"; names and values of the constants as
// in the nidaqmx package for Python, https://github.com/ni/nidaqmx-python (MIT licence).
namespace proofmass::acquire {

using DaqmxTaskHandle = void*;

/// The functions used, by their names without "DAQmx". Each returns a negative value on failure.
struct DaqmxCalls {
  std::int32_t (*create_task)(const char* name, DaqmxTaskHandle* task) = nullptr;
  std::int32_t (*create_ai_voltage_chan)(DaqmxTaskHandle task,
                                         const char* physical_channels,
                                         const char* names,
                                         std::int32_t terminals,
                                         double lowest,
                                         double highest,
                                         std::int32_t units,
                                         const char* custom_scale) = nullptr;
  std::int32_t (*cfg_samp_clk_timing)(DaqmxTaskHandle task,
                                      const char* source,
                                      double rate_hz,
                                      std::int32_t active_edge,
                                      std::int32_t sample_mode,
                                      std::uint64_t samples_per_channel) = nullptr;
  std::int32_t (*get_samp_clk_rate)(DaqmxTaskHandle task, double* rate_hz) = nullptr;
  std::int32_t (*start_task)(DaqmxTaskHandle task) = nullptr;
  std::int32_t (*stop_task)(DaqmxTaskHandle task) = nullptr;
  std::int32_t (*clear_task)(DaqmxTaskHandle task) = nullptr;
  std::int32_t (*read_analog_f64)(DaqmxTaskHandle task,
                                  std::int32_t samples_per_channel,
                                  double timeout_s,
                                  std::uint32_t fill_mode,
                                  double* into,
                                  std::uint32_t size,
                                  std::int32_t* samples_read,
                                  std::uint32_t* reserved) = nullptr;
  std::int32_t (*get_extended_error_info)(char* text, std::uint32_t size) = nullptr;
  std::int32_t (*get_sys_dev_names)(char* text, std::uint32_t size) = nullptr;
  std::int32_t (*get_dev_ai_physical_chans)(const char* device,
                                            char* text,
                                            std::uint32_t size) = nullptr;
  std::int32_t (*get_dev_product_type)(const char* device,
                                       char* text,
                                       std::uint32_t size) = nullptr;

  // Optional in a driver: nullptr if missing.
  std::int32_t (*get_ai_rng_low)(DaqmxTaskHandle, const char* channel, double* volts) = nullptr;
  std::int32_t (*get_ai_rng_high)(DaqmxTaskHandle, const char* channel, double* volts) = nullptr;
  std::int32_t (*get_ai_term_cfg)(DaqmxTaskHandle,
                                  const char* channel,
                                  std::int32_t* terminals) = nullptr;
  std::int32_t (*get_ai_conv_rate)(DaqmxTaskHandle, double* rate_hz) = nullptr;
  std::int32_t (*get_read_total_samp_per_chan_acquired)(DaqmxTaskHandle,
                                                        std::uint64_t* samples) = nullptr;
  std::int32_t (*get_dev_ai_voltage_rngs)(const char* device,
                                          double* volts,
                                          std::uint32_t size) = nullptr;
  std::int32_t (*get_dev_ai_max_multi_chan_rate)(const char* device, double* rate_hz) = nullptr;

  /// The driver's message for the last failure on this thread: one line.
  [[nodiscard]] std::string words(std::int32_t status) const;
};

/// Loads `library`, or the system's if it is empty, and never unloads it. Errors: unsupported
/// (absent, or a function is missing: which).
[[nodiscard]] Result<std::shared_ptr<const DaqmxCalls>> load_daqmx(const std::string& library);

/// "Dev1", "Dev2"; for one device "Dev1/ai0", …; "USB-6009". Empty if the driver does not report
/// it.
[[nodiscard]] std::vector<std::string> daqmx_devices(const DaqmxCalls& calls);
[[nodiscard]] std::vector<std::string> daqmx_channels_of(const DaqmxCalls& calls,
                                                         const std::string& device);
[[nodiscard]] std::string daqmx_product(const DaqmxCalls& calls, const std::string& device);

}  // namespace proofmass::acquire
