#pragma once
// Rays against the triangles of a PatchSet. Embree stays inside.

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/model/random_stream.h"
#include "solver/visibility/glossy_sides.h"
#include "solver/visibility/mirror_planes.h"

namespace clerestory {

struct Ray {
  Vec3 origin;     ///< already off its surface, see RayScene::off_surface() [m]
  Vec3 direction;  ///< unit
};

/// Key of the random numbers of `stream` that belong to a ray: the same for the same ray.
inline std::uint64_t key_of(const Ray& ray, std::uint64_t stream) {
  for (const Vec3* v : {&ray.origin, &ray.direction})
    for (const double x : {v->x, v->y, v->z}) stream = mix_bits(stream ^ std::bit_cast<std::uint64_t>(x)) + 1;
  return stream;
}

/// What a ray met first, mirrors apart.
struct Hit {
  PatchId patch;                ///< the side it met; invalid when it escaped, or met a side that takes no part
  TriangleId triangle;          ///< invalid when it escaped
  double distance = 0;          ///< along the unit direction [m]
  Spectrum transmittance{1.0};  ///< of glass and mirrors on the way

  double first = 0;                ///< distance to the first surface, be it a mirror [m]
  bool reflected = false;          ///< by mirrors on the way, or by glass
  std::uint32_t plane = kNoPlane;  ///< in which, when that is one: its number in RayScene::mirrors()
  Ray leg;                         ///< when reflected: the last part of the way; `distance` is its length then

  bool escaped() const { return !triangle.valid(); }
  /// Direction [unit] in which `ray` arrived here, and where that is.
  const Vec3& direction(const Ray& ray) const { return reflected ? leg.direction : ray.direction; }
  Vec3 position(const Ray& ray) const { return (reflected ? leg.origin : ray.origin) + direction(ray) * distance; }
};

/// What panes of glass turn back of a ray that goes on through them, and what a glossy surface that it ends on sends
/// along it beside its radiosity: one of these ways, chosen at random where there are several.
struct Echo {
  std::uint32_t plane = kNoPlane;  ///< of the pane; kNoPlane where a mirror comes before it, too, and of gloss
  Spectrum share{0.0};  ///< of the light that comes along it in what the ray brings; over the chance of the choice
  Ray ray;              ///< from the pane or the surface
  bool by_gloss = false;

  bool is_none() const { return share.is_black(); }
};

/// What turns a ray on its way: a pane that it goes on through, or the mirror that it ends on.
struct Turn {
  std::uint32_t plane;  ///< its number in RayScene::mirrors(), or kNoPlane
  Spectrum share;       ///< of the ray that goes on along `ray`
  Ray ray;
  bool is_mirror;
};

/// Sixteen segments for one packet, as separate coordinates; both ends already off their surfaces.
struct SegmentPacket {
  alignas(64) std::array<float, 16> from_x, from_y, from_z, to_x, to_y, to_z;
  std::array<Vec3, 16> from, to;  ///< the same; asked for where RayScene::has_tight_places()

  void set(int lane, const Vec3& start, const Vec3& end) {
    const auto k = static_cast<std::size_t>(lane);
    from[k] = start, to[k] = end;
    from_x[k] = static_cast<float>(start.x), from_y[k] = static_cast<float>(start.y);
    from_z[k] = static_cast<float>(start.z), to_x[k] = static_cast<float>(end.x);
    to_y[k] = static_cast<float>(end.y), to_z[k] = static_cast<float>(end.z);
  }
};

/// Read-only, thread safe. Opaque triangles block; glass lets its share pass, by the
/// angle (glass_sheet.h), and turns another back, which goes on as an Echo (echoes.h), as does what glossy surfaces
/// reflect beside their radiosity; mirrors turn first_hit() into another direction, up to 64 times. Knows triangles
/// only, so it stays valid when make_patches() changes which sides take part.
class RayScene {
 public:
  /// Deterministic for any thread count: the tree is built by one thread.
  explicit RayScene(const PatchSet& patches);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// First surface met, `patches` telling which side takes part as which patch.
  /// echo: null, or set to what glass on the way turns back, or gloss at its end sends on.
  Hit first_hit(const PatchSet& patches, const Ray& ray, Echo* echo = nullptr) const;
  /// The same for rays that go nearly the same way, in packets of 16; scattered ones are faster one by one.
  /// echoes: empty, or one a ray.
  void first_hits(const PatchSet& patches, std::span<const Ray> rays, std::span<Hit> hits,
                  std::span<Echo> echoes = {}) const;

  /// The same without following mirrors: a ray ends on one as on anything, and what that sends on is one of the ways
  /// that the echo is chosen among. Hit::patch of a mirror is invalid.
  Hit first_leg(const PatchSet& patches, const Ray& ray, Echo& echo) const;

  /// Distance to the first surface that is not glass; infinite when there is none [m].
  double first_surface(const Ray& ray) const;

  /// Bit k is set when nothing opaque blocks segment k; glass is ignored. `active` has a bit for each segment to test.
  std::uint16_t visible16(const SegmentPacket& segments, std::uint16_t active = 0xffff) const;
  /// Bit k is set where glass may take something of what passes along segment k, for those of `active`.
  std::uint16_t meets_glass(const SegmentPacket& segments, std::uint16_t active) const;

  /// Whether nothing opaque blocks one segment; glass is ignored.
  bool visible(const Vec3& from, const Vec3& to) const;

  /// Share of light that passes from `from` to `to` (both lifted): 0 when something opaque blocks.
  Spectrum transmittance(const Vec3& from, const Vec3& to) const;

  /// Share that glass lets through between two points that see each other; 1 without glass.
  Spectrum glass_transmittance(const Vec3& from, const Vec3& to) const;

  /// Share of light that gets to `from` over mirrors and panes of those planes, from a light whose image is at `image`:
  /// 0 when the way misses one of them or something blocks it.
  Spectrum transmittance_by_mirrors(const Vec3& from, const Vec3& image, const MirrorWay& way) const;
  /// All that turns a ray, from near to far, the way to it included.
  std::vector<Turn> turns(const Ray& ray) const;

  bool has_glass() const;
  bool has_mirrors() const;
  bool has_gloss() const;
  bool has_echoes() const { return has_glass() || (has_gloss() && !leaves_gloss_); }
  const GlossySides& gloss() const;
  /// Unit, of its front.
  Vec3 normal(TriangleId t) const;
  /// The place of its plane that x is nearest to: rays in float hit it only nearly.
  Vec3 in_plane_of(TriangleId t, const Vec3& x) const;
  /// Weights of its corners 1 and 2 at x, each in [0, 1].
  std::array<double, 2> barycentric(TriangleId t, const Vec3& x) const;
  /// Of the side that a ray along `direction` (unit) met in t; null: that is not glossy.
  const Lobe* lobe(TriangleId t, const Vec3& direction) const;
  /// The planes of mirrors, no more than 64 of them, then those of glass, the 64 of largest area: rays are reflected by
  /// all, lights have images in these.
  const std::vector<MirrorPlane>& mirrors() const;
  /// The number there of a mirror's or pane's plane; kNoPlane: it has none.
  std::uint32_t plane_of(TriangleId t) const;

  /// Where a ray starts or ends at the place p of a surface with unit normal n on the ray's side: lifted so far that
  /// rounding cannot put it behind the surface, and never so far that it passes another. That is lift() where no other
  /// surface is near; in tight places (tight_places.h) 1e-12 of the diagonal, and rays that start, end or land there
  /// are traced in double precision (fine_rays.h).
  Vec3 off_surface(const Vec3& p, const Vec3& n) const;
  /// Where rays start for a point in the air, p itself unless a surface is nearer than rounding: then on p's side of
  /// it, or, when p lies in it, on the side that n shows.
  Vec3 beside_surfaces(const Vec3& p, const Vec3& n) const;
  /// The same surfaces for rays whose ends are lifted half as far: what a lift does to a result is seen by rays that
  /// have another. (A quarter was too near: rounding put 0.2 % of the ends behind their surface.)
  RayScene with_nearer_ends() const;
  /// The same surfaces for those who look after lobes themselves: rays have no echo by gloss.
  RayScene without_gloss() const;
  /// The distance by which ray ends are lifted where there is room: 5e-7 of the diagonal, a few units in the last place
  /// at the rim of the scene [m].
  double lift() const;
  /// Whether p lies where surfaces are too near each other for that.
  bool is_tight(const Vec3& p) const;
  bool has_tight_places() const;
  /// Length of the diagonal of the bounding box [m].
  double diameter() const;

 private:
  struct Impl;
  RayScene(std::shared_ptr<const Impl> impl, double lift_share, bool leaves_gloss);
  std::shared_ptr<const Impl> impl_;
  double lift_share_ = 1;
  bool leaves_gloss_ = false;
};

}  // namespace clerestory
