#include "solver/hierarchy/element_mesh.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>
#include <OpenMesh/Tools/Utils/MeshCheckerT.hh>

#include "solver/hierarchy/leaves_behind.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kNone = VertexLightmap::kNone;

/// Order of edges by length; ends decide between equal ones, so that both elements at an edge agree.
struct EdgeKey {
  double length2;
  std::uint32_t low, high;
  friend auto operator<=>(const EdgeKey&, const EdgeKey&) = default;
};

EdgeKey edge_key(const std::vector<Vec3>& vertices, std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  const Vec3 d = vertices[high] - vertices[low];
  return {dot(d, d), low, high};
}

using Kernel = OpenMesh::TriConnectivity;
using HalfEdge = OpenMesh::HalfedgeHandle;
using Vertex = OpenMesh::VertexHandle;
using Face = OpenMesh::FaceHandle;

/// A number for each vertex, half-edge or face: a property of the kernel, looked up once.
template <class Handle, template <class> class Property>
class Numbers {
 public:
  explicit Numbers(Kernel& kernel) {
    Property<std::uint32_t> property;
    kernel.add_property(property);
    numbers_ = &kernel.property(property).data_vector();
  }
  std::uint32_t operator[](Handle h) const { return (*numbers_)[static_cast<std::size_t>(h.idx())]; }
  std::uint32_t& operator[](Handle h) { return (*numbers_)[static_cast<std::size_t>(h.idx())]; }

 private:
  std::vector<std::uint32_t>* numbers_;  ///< grows with the kernel
};

/// Corner k of patch p is 3 p + k.
using Corner = std::uint32_t;
Corner following(Corner c) { return c % 3 == 2 ? c - 2 : c + 1; }
Corner previous(Corner c) { return c % 3 == 0 ? c + 2 : c - 1; }

/// Corner by corner the vertices of the patches, counter-clockwise from their lit sides.
std::vector<std::uint32_t> vertices_at_corners(const PatchSet& patches) {
  std::vector<std::uint32_t> at;
  at.reserve(3 * patches.patch_count());
  for (std::size_t p = 0; p < patches.patch_count(); ++p) {
    const auto& c = patches.corners[patches.triangle[p]];
    const bool front = patches.side[p] == kFront;
    for (const std::size_t k : {std::size_t{0}, front ? std::size_t{1} : 2, front ? std::size_t{2} : 1})
      at.push_back(c[k].value);
  }
  return at;
}

/// The corner where the edge across from the one that starts at each corner starts; kNone at an open end. Both patches
/// must agree that they meet, or halving would wait for one that never comes.
std::vector<Corner> corners_across(const VertexLightmap& map, const std::vector<std::uint32_t>& vertex) {
  std::vector<Corner> across(vertex.size(), kNone);
  for (Corner c = 0; c < vertex.size(); ++c) {
    const std::uint32_t q = map.neighbour[c / 3][c % 3];
    if (q == kNone) continue;
    for (Corner d = 3 * q; d < 3 * q + 3; ++d)
      if (vertex[d] == vertex[following(c)] && vertex[following(d)] == vertex[c]) {
        if (map.neighbour[q][d % 3] == c / 3) across[c] = d;
        break;
      }
  }
  for (Corner c = 0; c < across.size(); ++c)
    if (across[c] != kNone && across[across[c]] != c) across[c] = kNone;
  return across;
}

/// Puts the open ends in a row around each hole: what enters a vertex is followed by what leaves it.
void close_boundary_loops(Kernel& kernel) {
  std::vector<HalfEdge> leaves(kernel.n_vertices());
  for (const HalfEdge h : kernel.halfedges())
    if (kernel.is_boundary(h)) leaves[static_cast<std::size_t>(kernel.from_vertex_handle(h).idx())] = h;
  for (const HalfEdge h : kernel.halfedges()) {
    if (!kernel.is_boundary(h)) continue;
    const HalfEdge next = leaves[static_cast<std::size_t>(kernel.to_vertex_handle(h).idx())];
    kernel.set_next_halfedge_handle(h, next);
    kernel.set_halfedge_handle(kernel.to_vertex_handle(h), next);
  }
}

}  // namespace

/// The leaves' faces. Where several rings of patches meet in one place each has a vertex of its own, so that what is
/// not manifold in space is so here.
struct ElementMesh::HalfEdges {
  Kernel kernel;
  Numbers<Vertex, OpenMesh::VPropHandleT> vertex{kernel};   ///< of ElementMesh::vertices_
  Numbers<HalfEdge, OpenMesh::HPropHandleT> point{kernel};  ///< of the lightmap, at the corner where a half-edge starts
  Numbers<Face, OpenMesh::FPropHandleT> element{kernel};    ///< leaf

  HalfEdges(const PatchSet& patches, const VertexLightmap& map);

  /// That of a leaf's longest edge is the one that its face keeps.
  HalfEdge longest(const Element& leaf) const { return kernel.halfedge_handle(Face(static_cast<int>(leaf.first))); }
  /// The half-edges that start at the corners of a leaf.
  std::array<HalfEdge, 3> around(const Element& leaf) const {
    std::array<HalfEdge, 3> at;
    at[leaf.edge] = longest(leaf);
    at[(leaf.edge + 1u) % 3] = kernel.next_halfedge_handle(at[leaf.edge]);
    at[(leaf.edge + 2u) % 3] = kernel.next_halfedge_handle(at[(leaf.edge + 1u) % 3]);
    return at;
  }

  std::uint32_t start(HalfEdge h) const { return vertex[kernel.from_vertex_handle(h)]; }
  std::uint32_t end(HalfEdge h) const { return vertex[kernel.to_vertex_handle(h)]; }
  std::uint32_t element_at(HalfEdge h) const { return kernel.is_boundary(h) ? kNone : element[kernel.face_handle(h)]; }
};

/// A face for each patch, neighbours joined over their edges. Not by add_face(), which refuses a wall one element long,
/// as both of its ends are the same edge.
ElementMesh::HalfEdges::HalfEdges(const PatchSet& patches, const VertexLightmap& map) {
  const std::vector<std::uint32_t> vertex_at = vertices_at_corners(patches);
  const std::vector<Corner> across = corners_across(map, vertex_at);
  const auto corners = static_cast<Corner>(vertex_at.size());
  std::vector<Vertex> at(corners);
  for (Corner c = 0; c < corners; ++c) {
    if (at[c].is_valid()) continue;
    const Vertex v = kernel.new_vertex();
    vertex[v] = vertex_at[c];
    for (Corner d = c; d != kNone && !at[d].is_valid();) {
      at[d] = v;
      d = across[d] == kNone ? kNone : following(across[d]);
    }
    for (Corner d = across[previous(c)]; d != kNone && !at[d].is_valid(); d = across[previous(d)]) at[d] = v;
  }
  std::vector<HalfEdge> edge(corners);
  for (Corner c = 0; c < corners; ++c) {
    if (edge[c].is_valid()) continue;
    edge[c] = kernel.new_edge(at[c], at[following(c)]);
    if (across[c] != kNone) edge[across[c]] = kernel.opposite_halfedge_handle(edge[c]);
  }
  for (Corner first = 0; first < corners; first += 3) {
    const Face face = kernel.new_face();
    element[face] = first / 3;
    kernel.set_halfedge_handle(face, edge[first]);
    for (Corner c = first; c < first + 3; ++c) {
      kernel.set_face_handle(edge[c], face);
      kernel.set_next_halfedge_handle(edge[c], edge[following(c)]);
      kernel.set_halfedge_handle(at[c], edge[c]);
      point[edge[c]] = map.corners[c / 3][c % 3];
    }
  }
  close_boundary_loops(kernel);
}

ElementMesh::ElementMesh(const PatchSet& patches, VertexLightmap map)
    : patches_(patches),
      vertices_(patches.vertices),
      half_edges_(std::make_unique<HalfEdges>(patches, map)),
      leaf_count_(patches.patch_count()) {
  points_ = std::move(map);
  points_.corners = {}, points_.neighbour = {}, points_.E = {};
  first_middle_ = points_.position.size();
  elements_.resize(patches.patch_count());
  for (std::uint32_t p = 0; p < elements_.size(); ++p) {
    elements_[p].area = patches.area[p], elements_[p].patch = p;
    describe(elements_[p], p, half_edges_->kernel.halfedge_handle(Face(static_cast<int>(p))).idx());
  }
}
ElementMesh::~ElementMesh() = default;
ElementMesh::ElementMesh(ElementMesh&&) noexcept = default;

/// Makes the face of the half-edge that starts at its corner 0 that of a leaf.
void ElementMesh::describe(Element& leaf, std::uint32_t number, int corner0) {
  Kernel& kernel = half_edges_->kernel;
  HalfEdge h(corner0), longest_one = h;
  const Face face = kernel.face_handle(h);
  half_edges_->element[face] = number;
  leaf.first = static_cast<std::uint32_t>(face.idx());
  leaf.edge = 0;
  const auto key = [&] { return edge_key(vertices_, half_edges_->start(h), half_edges_->end(h)); };
  EdgeKey longest = key();
  for (std::uint8_t k = 1; k < 3; ++k) {
    h = kernel.next_halfedge_handle(h);
    if (const EdgeKey here = key(); here > longest) longest = here, leaf.edge = k, longest_one = h;
  }
  kernel.set_halfedge_handle(face, longest_one);
}

namespace {

/// Corners of a parted element from those of its parts.
template <class Corners>
Corners corners_of_whole(std::size_t edge, const Corners& first, const Corners& second) {
  Corners whole;
  whole[edge] = first[0], whole[(edge + 1) % 3] = second[1], whole[(edge + 2) % 3] = first[2];
  return whole;
}

}  // namespace

ElementMesh::Corners ElementMesh::vertices(std::uint32_t e) const {
  const Element& element = elements_[e];
  if (element.parted) return corners_of_whole(element.edge, vertices(element.first), vertices(element.first + 1));
  const auto h = half_edges_->around(element);
  return {half_edges_->start(h[0]), half_edges_->start(h[1]), half_edges_->start(h[2])};
}

ElementMesh::Corners ElementMesh::points_of(std::uint32_t e) const {
  const Element& element = elements_[e];
  if (element.parted) return corners_of_whole(element.edge, points_of(element.first), points_of(element.first + 1));
  const auto h = half_edges_->around(element);
  return {half_edges_->point[h[0]], half_edges_->point[h[1]], half_edges_->point[h[2]]};
}

ElementMesh::Corners ElementMesh::neighbours(std::uint32_t leaf) const {
  const auto h = half_edges_->around(elements_[leaf]);
  const auto across = [&](std::size_t k) {
    return half_edges_->element_at(half_edges_->kernel.opposite_halfedge_handle(h[k]));
  };
  return {across(0), across(1), across(2)};
}

std::array<Vec3, 3> ElementMesh::corner_positions(std::uint32_t e) const {
  const Element& element = elements_[e];
  if (element.parted)
    return corners_of_whole(element.edge, corner_positions(element.first), corner_positions(element.first + 1));
  const auto h = half_edges_->around(element);
  return {vertices_[half_edges_->start(h[0])], vertices_[half_edges_->start(h[1])],
          vertices_[half_edges_->start(h[2])]};
}

double ElementMesh::longest_edge(std::uint32_t leaf) const {
  const HalfEdge h = half_edges_->longest(elements_[leaf]);
  return std::sqrt(edge_key(vertices_, half_edges_->start(h), half_edges_->end(h)).length2);
}

void ElementMesh::split(std::span<const std::uint32_t> marked) {
  const Kernel& kernel = half_edges_->kernel;
  std::vector<std::uint32_t> path;
  for (const std::uint32_t e : marked) {
    path.assign(1, e);
    while (!path.empty()) {
      const Element& here = elements_[path.back()];
      if (here.parted) {  // halved on the way to another
        path.pop_back();
        continue;
      }
      const HalfEdge back = kernel.opposite_halfedge_handle(half_edges_->longest(here));
      const bool waits = !kernel.is_boundary(back) && kernel.halfedge_handle(kernel.face_handle(back)) != back;
      if (waits) {
        path.push_back(half_edges_->element_at(back));
      } else {
        part_with_neighbour(path.back(), here.edge, 0.5f);
        path.pop_back();
      }
    }
  }
}

void ElementMesh::cut(std::uint32_t leaf, std::size_t k, double at) {
  // So that 1 - at is exact for the neighbour, whose edge runs the other way.
  constexpr double kSteps = 1 << 20;
  part_with_neighbour(leaf, k, static_cast<float>(std::clamp(std::round(at * kSteps), 1.0, kSteps - 1) / kSteps));
}

/// A leaf about to be parted at an edge.
struct ElementMesh::Parting {
  std::uint32_t element;
  std::uint8_t edge;
  Corners point;  ///< where the edge starts, where it ends, at the apex
  Vec3 apex;
};

void ElementMesh::part_with_neighbour(std::uint32_t element, std::size_t edge, float at) {
  Kernel& kernel = half_edges_->kernel;
  const auto parting = [&](HalfEdge h) {
    const HalfEdge to_apex = kernel.next_halfedge_handle(h), from_apex = kernel.next_halfedge_handle(to_apex);
    const std::uint32_t element_there = half_edges_->element_at(h);
    const auto around = half_edges_->around(elements_[element_there]);
    return Parting{element_there,
                   static_cast<std::uint8_t>(std::ranges::find(around, h) - around.begin()),
                   {half_edges_->point[h], half_edges_->point[to_apex], half_edges_->point[from_apex]},
                   vertices_[half_edges_->start(from_apex)]};
  };
  const HalfEdge h = half_edges_->around(elements_[element])[edge], back = kernel.opposite_halfedge_handle(h);
  const Vertex start = kernel.from_vertex_handle(h), end = kernel.to_vertex_handle(h);
  const Vec3 place = vertices_[half_edges_->start(h)] * (1 - double{at}) + vertices_[half_edges_->end(h)] * double{at};
  const bool alone = kernel.is_boundary(back);
  const Parting here = parting(h), there = alone ? Parting{} : parting(back);
  const bool smooth = !alone && there.point[0] == here.point[1] && there.point[1] == here.point[0];
  const double way =
      !alone && !smooth && is_outline(here, there) ? VertexLightmap::kWayFromOutline : VertexLightmap::kWayToCentroid;
  const std::uint32_t point = add_point(here, smooth ? &there : nullptr, way, place);
  const std::uint32_t point_there = alone || smooth ? point : add_point(there, nullptr, way, place);

  const Vertex middle = kernel.new_vertex();
  half_edges_->vertex[middle] = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(place);
  kernel.split(kernel.edge_handle(h), middle);
  const HalfEdge to_end = kernel.find_halfedge(middle, end), to_start = kernel.find_halfedge(middle, start);

  /// Both parts, from the half-edges on either side of the middle; OpenMesh knows nothing of what they carry.
  const auto part = [&](const Parting& was, float share, std::uint32_t middle_point, HalfEdge first, HalfEdge second) {
    Element& whole = elements_[was.element];
    Element half = whole;
    half.level = static_cast<std::uint8_t>(whole.level + 1);
    whole.parted = true, whole.at = share, whole.edge = was.edge;
    whole.first = static_cast<std::uint32_t>(elements_.size());
    const double area = whole.area;
    const auto add = [&](HalfEdge corner0, const Corners& points, double part_of_area) {
      HalfEdge at_corner = corner0;
      for (const std::uint32_t p : points)
        half_edges_->point[at_corner] = p, at_corner = kernel.next_halfedge_handle(at_corner);
      half.area = part_of_area;
      describe(half, static_cast<std::uint32_t>(elements_.size()), corner0.idx());
      elements_.push_back(half);
    };
    add(first, {was.point[0], middle_point, was.point[2]}, area * double{share});
    add(second, {middle_point, was.point[1], was.point[2]}, area * (1 - double{share}));
    ++leaf_count_;
  };
  part(here, at, point, kernel.opposite_halfedge_handle(to_start), to_end);
  // The neighbour's edge runs the other way.
  if (!alone) part(there, 1 - at, point_there, kernel.opposite_halfedge_handle(to_end), to_start);
}

/// Between elements that share no points at their edge: whether the surface goes on there all the same.
bool ElementMesh::is_outline(const Parting& here, const Parting& there) const {
  const PatchId p{std::size_t{elements_[here.element].patch}}, q{std::size_t{elements_[there.element].patch}};
  return patches_.material(p) == patches_.material(q) &&
         dot(patches_.normal[p], patches_.normal[q]) > VertexLightmap::kAlike;
}

std::uint32_t ElementMesh::add_point(const Parting& here, const Parting* other, double way, const Vec3& place) {
  const auto point = static_cast<std::uint32_t>(points_.position.size());
  const std::uint32_t patch = elements_[here.element].patch;
  points_.position.push_back(place);
  points_.patch_of_point.push_back(patch);
  ends_.push_back({here.point[0], here.point[1]});
  const Vec3 along = points_.position[here.point[0]] - points_.position[here.point[1]];
  const auto sample = [&](const Parting& facet, double weight) {
    const Vec3 to_centroid = (facet.apex - place) / 3;
    const double height = length(cross(facet.apex - place, along)) / length(along);
    points_.sample_position.push_back(place + to_centroid *
                                                  std::max(way, VertexLightmap::way_inside(height, points_.off_edges)));
    points_.sample_normal.push_back(patches_.normal[elements_[facet.element].patch]);
    points_.sample_weight.push_back(weight);
  };
  const bool bent =
      other && dot(patches_.normal[patch], patches_.normal[elements_[other->element].patch]) < VertexLightmap::kAlike;
  sample(here, bent ? 0.5 : 1);
  if (bent) sample(*other, 0.5);
  points_.sample_begin.push_back(static_cast<std::uint32_t>(points_.sample_position.size()));
  return point;
}

std::vector<std::uint32_t> ElementMesh::leaves() const {
  std::vector<std::uint32_t> leaves, stack;
  leaves.reserve(leaf_count_);
  for (std::uint32_t p = 0; p < patches_.patch_count(); ++p) {
    stack.assign(1, p);
    while (!stack.empty()) {
      const std::uint32_t e = stack.back();
      stack.pop_back();
      if (elements_[e].is_leaf()) {
        leaves.push_back(e);
      } else {
        stack.push_back(elements_[e].first + 1);
        stack.push_back(elements_[e].first);
      }
    }
  }
  return leaves;
}

std::size_t ElementMesh::leaves_under(std::uint32_t e) const {
  const std::uint32_t first = elements_[e].first;
  return elements_[e].is_leaf() ? 1 : leaves_under(first) + leaves_under(first + 1);
}

PatchSet ElementMesh::leaf_patches() const {
  const std::vector<std::uint32_t> leaf = leaves();
  const std::size_t n = leaf.size();
  PatchSet out;
  out.origin = patches_.origin;
  out.channels = patches_.channels;
  out.vertices = vertices_;
  out.materials = patches_.materials;
  out.surfaces = patches_.surfaces;
  out.rooms = patches_.rooms;
  out.side_patch = patches_.side_patch;
  out.splits.resize(elements_.size());
  for (std::size_t e = 0; e < elements_.size(); ++e)
    if (elements_[e].parted) out.splits[e] = {elements_[e].first, SplitNode::kNone, elements_[e].at, elements_[e].edge};
  out.corners.resize(n), out.side_material.resize(n), out.side_surface.resize(n);
  out.triangle.resize(n), out.side.resize(n), out.area.resize(n), out.normal.resize(n);
  out.level.resize(n);
  if (!patches_.joined.empty()) out.joined.resize(n);
  if (!patches_.space.empty()) out.space.resize(n);
  if (!patches_.room.empty()) out.room.resize(n);
  out.rho = out.M = Field(n, patches_.channels);
  for (std::size_t i = 0; i < n; ++i) {
    const Element& e = elements_[leaf[i]];
    const Corners vertex = vertices(leaf[i]);
    const TriangleId t = patches_.triangle[e.patch];
    const Side side = patches_.side[e.patch];
    const bool front = side == kFront;
    out.splits[leaf[i]].patch = static_cast<std::uint32_t>(i);
    out.corners[i] = {VertexId{std::size_t{vertex[0]}}, VertexId{std::size_t{vertex[front ? 1 : 2]}},
                      VertexId{std::size_t{vertex[front ? 2 : 1]}}};
    out.side_material[i] = patches_.side_material[t];
    out.side_surface[i] = patches_.side_surface[t];
    if (!out.joined.empty()) out.joined[i] = patches_.joined[t];
    if (!out.space.empty()) out.space[i] = patches_.space[e.patch];
    if (!out.room.empty()) out.room[i] = patches_.room[e.patch];
    out.triangle[i] = TriangleId{i};
    out.side[i] = side;
    out.area[i] = e.area;
    out.normal[i] = patches_.normal[e.patch];
    out.level[i] = e.level;
    out.rho.set(i, patches_.rho[e.patch]);
    out.M.set(i, patches_.M[e.patch]);
  }
  std::vector<std::uint32_t> patch_of_leaf(n);
  for (std::size_t i = 0; i < n; ++i) patch_of_leaf[i] = elements_[leaf[i]].patch;
  find_leaves_behind(patches_, patch_of_leaf, out);
  return out;
}

VertexLightmap ElementMesh::leaf_lightmap() && {
  const std::vector<std::uint32_t> leaf = leaves();
  std::vector<std::uint32_t> number(elements_.size(), kNone);
  for (std::uint32_t i = 0; i < leaf.size(); ++i) number[leaf[i]] = i;
  VertexLightmap map = std::move(points_);
  map.corners.resize(leaf.size());
  map.neighbour.resize(leaf.size());
  for (std::uint32_t i = 0; i < leaf.size(); ++i) {
    map.corners[i] = points_of(leaf[i]);
    const Corners neighbour = neighbours(leaf[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      map.neighbour[i][k] = neighbour[k] == kNone ? kNone : number[neighbour[k]];
      map.patch_of_point[map.corners[i][k]] = i;
    }
  }
  map.E = Field(map.position.size(), patches_.channels);
  return map;
}

bool ElementMesh::is_sound() const {
  std::ostringstream what;
  return OpenMesh::Utils::MeshCheckerT<Kernel>(half_edges_->kernel)
      .check(OpenMesh::Utils::MeshCheckerT<Kernel>::CHECK_ALL, what);
}

}  // namespace clerestory
