#include "solver/hierarchy/sky_views.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <vector>

#include "solver/hierarchy/receiver_area.h"
#include "solver/hierarchy/receivers.h"
#include "solver/model/parallel.h"
#include "solver/sampling/packed_direction.h"

namespace clerestory {
namespace {

constexpr int kPassesBits = 11;  // a channel; 0.00025 off at most, to either side
constexpr double kAll = (1 << kPassesBits) - 1;
static_assert(kDirectionBits + 3 * kPassesBits <= 64);

Spectrum passes_of(SkyView view) {
  const auto channel = [&](int k) {
    return static_cast<double>(view.bits >> (kDirectionBits + k * kPassesBits) & ((1 << kPassesBits) - 1)) / kAll;
  };
  return {channel(0), channel(1), channel(2)};
}

Vec3 direction_of(SkyView view) {
  return unpack_direction(static_cast<std::uint32_t>(view.bits & ((1u << kDirectionBits) - 1)));
}

/// Memory that blocks need in turn.
struct Workspace {
  ReceiverArea area;
  std::vector<double> from_view;  ///< by lane
  std::vector<double> sum;        ///< by member and lane
  std::array<double, kMostMembers> share{};
};

/// Lanes that a view adds to.
struct LaneRange {
  std::size_t begin = 0, end = 0;
};

/// look(direction, passes, from_view): fills the lanes that it returns.
template <class Look>
void look_at_block(const LinkBlock& block, const ElementTree& tree, const PatchSet& patches, std::size_t lanes,
                   const Look& look, Workspace& work, Field& E) {
  work.from_view.resize(lanes);
  std::size_t view = 0, shared = 0;
  for (const Receiver& r : block.receivers) {
    const std::size_t members = r.leaf_end - r.first_leaf;
    if (r.hands_down) work.area.look_at(r, tree, patches);
    work.sum.assign(members * lanes, 0.0);
    for (const std::size_t last = view + r.views; view < last; ++view) {
      const LaneRange at = look(direction_of(block.views[view]), passes_of(block.views[view]), work.from_view);
      if (!r.hands_down) {
        for (std::size_t l = at.begin; l < at.end; ++l) work.sum[l] += work.from_view[l];
        continue;
      }
      const SharedView& way = block.shared_views[shared++];
      work.area.find_shares(unpack_direction(way.leaves), std::span(work.share).first(members));
      for (std::size_t m = 0; m < members; ++m)
        for (std::size_t l = at.begin; l < at.end && (way.members >> m & 1) != 0; ++l)
          work.sum[m * lanes + l] += work.share[m] * work.from_view[l];
    }
    const double weight = std::numbers::pi * double{r.view_weight};
    for (std::size_t m = 0; m < members; ++m)
      for (std::size_t l = 0; l < lanes; ++l)
        E.value[tree.patch[r.first_leaf + m] * lanes + l] = weight * work.sum[m * lanes + l];
  }
}

template <class Look>
Field look_at_all(const PatchSet& patches, const ElementTree& tree, const Transport& transport, std::size_t lanes,
                  const Look& look) {
  Field E(patches.patch_count(), static_cast<int>(lanes));
  parallel_for(transport.blocks.size(), 4, [&](std::size_t begin, std::size_t end) {
    Workspace work;
    for (std::size_t b = begin; b < end; ++b) look_at_block(transport.blocks[b], tree, patches, lanes, look, work, E);
  });
  return E;
}

}  // namespace

SkyView pack_sky_view(const Vec3& direction, const Spectrum& passes) {
  SkyView view{pack_direction(direction)};
  for (int k = 0; k < kMaxChannels; ++k)
    view.bits |= static_cast<std::uint64_t>(std::clamp(passes[k], 0.0, 1.0) * kAll + 0.5)
                 << (kDirectionBits + k * kPassesBits);
  return view;
}

Field sky_irradiance(const PatchSet& patches, const ElementTree& tree, const Transport& transport,
                     std::span<const SkyRadiance* const> skies) {
  const auto channels = static_cast<std::size_t>(patches.channels), lanes = skies.size() * channels;
  return look_at_all(patches, tree, transport, lanes,
                     [&](const Vec3& d, const Spectrum& passes, std::vector<double>& from_view) {
                       for (std::size_t s = 0; s < skies.size(); ++s) {
                         const Spectrum light = (*skies[s])(d)*passes;
                         for (std::size_t c = 0; c < channels; ++c)
                           from_view[s * channels + c] = light[static_cast<int>(c)];
                       }
                       return LaneRange{0, lanes};
                     });
}

Field sky_irradiance_by_part(const PatchSet& patches, const ElementTree& tree, const Transport& transport,
                             std::size_t parts, const std::function<std::size_t(const Vec3&)>& part_of) {
  const auto channels = static_cast<std::size_t>(patches.channels);
  return look_at_all(patches, tree, transport, parts * channels,
                     [&](const Vec3& d, const Spectrum& passes, std::vector<double>& from_view) {
                       const std::size_t part = part_of(d);
                       if (part >= parts) return LaneRange{};
                       for (std::size_t c = 0; c < channels; ++c)
                         from_view[part * channels + c] = passes[static_cast<int>(c)];
                       return LaneRange{part * channels, (part + 1) * channels};
                     });
}

}  // namespace clerestory
