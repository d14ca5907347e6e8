#include "proofmass/acquire/daqmx/library.hpp"

#include <algorithm>
#include <array>
#include <dlfcn.h>
#include <fmt/format.h>
#include <functional>

namespace proofmass::acquire {
namespace {

Error no_library(const std::string& why) {
  return {Errc::unsupported,
          fmt::format("NI-DAQmx {}; install National Instruments' driver, or set "
                      "PROOFMASS_NIDAQMX_LIB or library=PATH to its libnidaqmx.so",
                      why)};
}

/// The library under one of its names; the loader's message for the last name if none is found.
Result<void*> loaded(const std::string& library) {
  std::string why;
  for (const char* name : {"libnidaqmx.so.1", "libnidaqmx.so"}) {
    // Never unloaded, because it has threads.
    void* found =
        ::dlopen(library.empty() ? name : library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (found != nullptr) return found;
    const char* said = ::dlerror();
    why = said != nullptr ? said : "it cannot be loaded";
    if (!library.empty()) break;
  }
  return no_library("is not installed: " + why);
}

template <class Function>
bool find(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(::dlsym(library, name));
  return function != nullptr;
}

/// The name of a missing function; nullptr if none is missing.
const char* find_required(void* library, DaqmxCalls& calls) {
  const char* missing = nullptr;
  const auto need = [&](const char* name, auto& function) {
    if (!find(library, name, function) && missing == nullptr) missing = name;
  };
  need("DAQmxCreateTask", calls.create_task);
  need("DAQmxCreateAIVoltageChan", calls.create_ai_voltage_chan);
  need("DAQmxCfgSampClkTiming", calls.cfg_samp_clk_timing);
  need("DAQmxGetSampClkRate", calls.get_samp_clk_rate);
  need("DAQmxStartTask", calls.start_task);
  need("DAQmxStopTask", calls.stop_task);
  need("DAQmxClearTask", calls.clear_task);
  need("DAQmxReadAnalogF64", calls.read_analog_f64);
  need("DAQmxGetExtendedErrorInfo", calls.get_extended_error_info);
  need("DAQmxGetSysDevNames", calls.get_sys_dev_names);
  need("DAQmxGetDevAIPhysicalChans", calls.get_dev_ai_physical_chans);
  need("DAQmxGetDevProductType", calls.get_dev_product_type);
  return missing;
}

void find_optional(void* library, DaqmxCalls& calls) {
  find(library, "DAQmxGetAIRngLow", calls.get_ai_rng_low);
  find(library, "DAQmxGetAIRngHigh", calls.get_ai_rng_high);
  find(library, "DAQmxGetAITermCfg", calls.get_ai_term_cfg);
  find(library, "DAQmxGetAIConvRate", calls.get_ai_conv_rate);
  find(library, "DAQmxGetReadTotalSampPerChanAcquired",
       calls.get_read_total_samp_per_chan_acquired);
  find(library, "DAQmxGetDevAIVoltageRngs", calls.get_dev_ai_voltage_rngs);
  find(library, "DAQmxGetDevAIMaxMultiChanRate", calls.get_dev_ai_max_multi_chan_rate);
}

using GetText = std::function<std::int32_t(char* text, std::uint32_t size)>;

/// Called with no buffer, the driver returns the required size.
std::string text_of(const GetText& get) {
  constexpr std::int32_t most = 1 << 20;
  const std::int32_t size = get(nullptr, 0);
  if (size <= 0 || size > most) return {};
  std::string text(static_cast<std::size_t>(size), '\0');
  if (get(text.data(), static_cast<std::uint32_t>(size)) < 0) return {};
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

/// "Dev1, Dev2" split into parts.
std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from < list.size();) {
    const std::size_t comma = std::min(list.find(',', from), list.size());
    const std::size_t begin = std::min(list.find_first_not_of(" ", from), comma);
    if (comma > begin) parts.push_back(list.substr(begin, comma - begin));
    from = comma + 1;
  }
  return parts;
}

}  // namespace

std::string DaqmxCalls::words(std::int32_t status) const {
  std::array<char, 2048> text{};
  const std::int32_t written =
      get_extended_error_info(text.data(), static_cast<std::uint32_t>(text.size() - 1));
  std::string line =
      written < 0 || text.front() == '\0' ? "the driver gives no reason" : text.data();
  std::ranges::replace_if(line, [](unsigned char c) { return c < ' '; }, ' ');
  line.erase(std::ranges::unique(line, [](char a, char b) { return a == ' ' && b == ' '; }).begin(),
             line.end());
  while (line.ends_with(' ') || line.ends_with('.')) line.pop_back();
  return fmt::format("{} (NI-DAQmx {})", line, status);
}

Result<std::shared_ptr<const DaqmxCalls>> load_daqmx(const std::string& library) {
  const auto handle = loaded(library);
  if (!handle) return handle.error();
  auto calls = std::make_shared<DaqmxCalls>();
  if (const char* missing = find_required(*handle, *calls); missing != nullptr)
    return no_library(fmt::format("cannot be used: its library has no {}", missing));
  find_optional(*handle, *calls);
  return std::shared_ptr<const DaqmxCalls>(std::move(calls));
}

std::vector<std::string> daqmx_devices(const DaqmxCalls& calls) {
  return parts_of(text_of(calls.get_sys_dev_names));
}

std::vector<std::string> daqmx_channels_of(const DaqmxCalls& calls, const std::string& device) {
  return parts_of(text_of([&](char* text, std::uint32_t size) {
    return calls.get_dev_ai_physical_chans(device.c_str(), text, size);
  }));
}

std::string daqmx_product(const DaqmxCalls& calls, const std::string& device) {
  return text_of([&](char* text, std::uint32_t size) {
    return calls.get_dev_product_type(device.c_str(), text, size);
  });
}

}  // namespace proofmass::acquire
