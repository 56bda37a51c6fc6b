#include "solver/visibility/embree_device.h"

#include <new>
#include <stdexcept>

#include <embree3/rtcore.h>

namespace clerestory {
namespace {

[[noreturn]] void refuse(RTCError error) {
  if (error == RTC_ERROR_UNSUPPORTED_CPU) throw std::runtime_error("Embree does not run on this processor");
  throw std::bad_alloc();  // it wants memory and threads, and says "unknown" for both
}

}  // namespace

EmbreeDevice::EmbreeDevice() : handle(rtcNewDevice("set_affinity=0")) {
  if (!handle) refuse(rtcGetDeviceError(nullptr));
}

EmbreeDevice::~EmbreeDevice() { rtcReleaseDevice(handle); }

void EmbreeDevice::check() const {
  if (const RTCError error = rtcGetDeviceError(handle); error != RTC_ERROR_NONE) refuse(error);
}

}  // namespace clerestory
