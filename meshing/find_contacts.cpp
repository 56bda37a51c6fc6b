#include "meshing/find_contacts.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "solver/model/box_tree.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

double longest_edge(const FaceComplex& complex, const Face& f) {
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k)
    longest = std::max(longest, length(complex.vertices[f.corner[(k + 1) % 3]] - complex.vertices[f.corner[k]]));
  return longest;
}

/// The part of a face that lies in a plane it is not parallel to.
struct Trace {
  std::array<Vec3, 2> end;
};

std::optional<Trace> trace(const FaceComplex& complex, const Face& face, const Plane& plane, double tolerance) {
  std::array<Vec3, 3> p;
  std::array<double, 3> d;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = complex.vertices[face.corner[k]];
    d[k] = plane.distance(p[k]);
    if (std::abs(d[k]) <= tolerance) d[k] = 0;
  }
  std::array<Vec3, 3> found;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (d[k] == 0) found[count++] = p[k];
  if (count == 3) return std::nullopt;  // parallel within tolerance: its edges and vertices speak for it
  for (std::size_t k = 0; k < 3 && count < 2; ++k) {
    const std::size_t j = (k + 1) % 3;
    if (d[k] * d[j] < 0) found[count++] = p[k] + (p[j] - p[k]) * (d[k] / (d[k] - d[j]));
  }
  if (count == 0) return std::nullopt;
  return Trace{{found[0], found[count == 2 ? 1 : 0]}};
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double dd = dot(d, d);
  const double t = dd > 0 ? std::clamp(dot(p - a, d) / dd, 0.0, 1.0) : 0;
  return length(p - a - d * t);
}

std::optional<Contact> contact(const FaceComplex& complex, std::uint32_t face_a, std::uint32_t face_b,
                               const Plane& plane_a, const Plane& plane_b) {
  const Face &a = complex.faces[face_a], &b = complex.faces[face_b];
  const double tolerance =
      std::min(complex.allowed.contact,
               complex.allowed.local_share * std::min(longest_edge(complex, a), longest_edge(complex, b)));
  // Faces that are almost parallel meet in no particular line.
  const Vec3 along = cross(plane_a.n, plane_b.n);
  if (length(along) < 2e-3) return std::nullopt;
  const auto ta = trace(complex, a, plane_b, tolerance);
  if (!ta) return std::nullopt;
  const auto tb = trace(complex, b, plane_a, tolerance);
  if (!tb) return std::nullopt;
  // Along the common line: the later of the starts to the earlier of the ends.
  auto [a0, a1] = ta->end;
  auto [b0, b1] = tb->end;
  if (dot(a1 - a0, along) < 0) std::swap(a0, a1);
  if (dot(b1 - b0, along) < 0) std::swap(b0, b1);
  const Vec3 start = dot(b0 - a0, along) > 0 ? b0 : a0;
  const Vec3 end = dot(b1 - a1, along) < 0 ? b1 : a1;
  if (dot(end - start, along) < -tolerance * length(along)) return std::nullopt;
  // Between nearly parallel faces the line is ill defined; trust only what lies on both.
  for (const Vec3& p : {start, end})
    if (distance_to_segment(p, a0, a1) > 3 * tolerance || distance_to_segment(p, b0, b1) > 3 * tolerance)
      return std::nullopt;
  return Contact{face_a, face_b, {start, end}, tolerance};
}

}  // namespace

std::vector<Contact> find_contacts(const FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                   const std::vector<std::uint32_t>& group_of) {
  const std::size_t count = complex.faces.size();
  // What contact() takes for rounding, and no more: beside a stray face far away that of the model covers all the rest.
  std::vector<double> margin(count);
  for (std::size_t f = 0; f < count; ++f)
    margin[f] =
        std::min(complex.allowed.contact / 2, complex.allowed.local_share * longest_edge(complex, complex.faces[f]));
  const auto box_of = [&](std::size_t f) {
    Box box;
    for (const std::uint32_t v : complex.faces[f].corner) box.add(complex.vertices[v]);
    return box.grown(margin[f]);
  };
  const BoxTree tree(count, box_of);
  constexpr std::uint32_t kSeveral = 0xffffffff;
  const auto one_group = tree.by_node([&](std::uint32_t f) { return group_of[f]; },
                                      [](std::uint32_t g, std::uint32_t h) { return g == h ? g : kSeveral; });
  const CrowdLimit pairs{"pairs of faces of different planes touch by their boxes", 20'000'000 + 500 * count};
  const CrowdLimit contacts{"pairs of faces cross or touch", 100'000 + 20 * count};
  std::atomic<std::size_t> all_met = 0, all_found = 0;
  constexpr std::size_t kGrain = 256;
  std::vector<std::vector<Contact>> found((count + kGrain - 1) / kGrain);
  parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk)
      for (std::size_t k = chunk * kGrain; k < std::min(count, (chunk + 1) * kGrain); ++k) {
        if (all_met > pairs.most || all_found > contacts.most) return;
        const std::uint32_t f = tree.order()[k];
        const auto& cf = complex.faces[f].corner;
        const std::size_t found_before = found[chunk].size();
        std::size_t met = 0;
        const Box around = box_of(f);
        const auto meet = [&](std::uint32_t g) {
          if (g <= f || group_of[g] == group_of[f]) return;
          ++met;
          const auto& cg = complex.faces[g].corner;
          int shared = 0;
          Vec3 common;
          for (const std::uint32_t v : cf)
            if (v == cg[0] || v == cg[1] || v == cg[2]) {
              ++shared;
              common = complex.vertices[v];
            }
          if (shared >= 2) return;  // a common edge, drawn already
          const auto c = contact(complex, f, g, groups[group_of[f]].plane, groups[group_of[g]].plane);
          // Most that touch do so in a common corner, which is drawn too.
          if (c && !(shared == 1 && c->end[0] == common && c->end[1] == common)) found[chunk].push_back(*c);
        };
        tree.visit_if([&](const Box& b) { return b.touches(around); }, meet,
                      [&](std::size_t node) { return one_group[node] != group_of[f]; });
        all_met += met;
        all_found += found[chunk].size() - found_before;
      }
  });
  pairs.check(all_met, complex);
  contacts.check(all_found, complex);
  std::vector<Contact> all;
  for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end(), [](const Contact& x, const Contact& y) {
    return x.face_a != y.face_a ? x.face_a < y.face_a : x.face_b < y.face_b;
  });
  return all;
}

}  // namespace clerestory
