#pragma once
// One Embree device.

struct RTCDeviceTy;

namespace clerestory {

struct EmbreeDevice {
  RTCDeviceTy* handle;

  /// throws  std::bad_alloc where Embree finds no memory or threads, std::runtime_error on a processor without SSE2.
  EmbreeDevice();
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;
  ~EmbreeDevice();

  /// After a commit: a scene that could not be built would let all rays pass. Throws as the constructor does.
  void check() const;
};

}  // namespace clerestory
