// Converged irradiance at sensor points by paths, added in rounds until the standard error is small enough; the judge
// of the rows in history/hierarchy.csv. A run continues the file that an earlier one wrote.
//   path_reference SCENE POINTS.csv OUT.csv [options, see usage below]

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>

#include "io/read_scene.h"
#include "io/read_sensors.h"
#include "solver/lights/sun.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/sampling/unit_square.h"
#include "tests/bench/bare_problem.h"

namespace clerestory {
namespace {

constexpr const char* kUsage =
    "usage: path_reference SCENE POINTS.csv OUT.csv [options]\n"
    "  --error SHARE          standard error asked for, of the mean of all points or the point's own value, whichever\n"
    "                         is larger                                               (default: 0.002)\n"
    "  --own-error SHARE      and of the own value or 2 % of the mean                 (default: 0.005)\n"
    "  --seconds S            stop after so many seconds                              (default: no limit)\n"
    "  --threads N            0 = all cores                                           (default: 1)\n"
    "  --sun-patch X0,Y0,X1,Y1,Z   the sun falls into the room on this rectangle only\n";

/// A horizontal rectangle that holds all the sun's light in the room: paths look for it instead of for the sun, which
/// they would find from one place in a hundred.
struct SunPatch {
  double x0, y0, x1, y1, z;
  Spectrum rho{};

  double area() const { return (x1 - x0) * (y1 - y0); }
};

struct Arguments {
  std::string scene, points, output;
  double error = 0.002, own_error = 0.005, seconds = 1e9;
  int threads = 1;
  std::optional<SunPatch> sun_patch;
};

/// Irradiance in lux at one point so far: independent replicates of kPaths stratified paths each.
struct Estimate {
  static constexpr int kPaths = 2048;
  static constexpr int kFewest = 8;
  double mean = 0, squares = 0;  ///< mean, and sum of squared differences to it [lx], [lx2]
  long count = 0;

  void add(double x) {
    ++count;
    const double d = x - mean;
    mean += d / static_cast<double>(count);
    squares += d * (x - mean);
  }
  double std_error() const {
    return count < 2 ? 0 : std::sqrt(squares / (static_cast<double>(count) * static_cast<double>(count - 1)));
  }
};

/// Light [W/m2] at p that the floor reflects from the sun's patch, by one point of it.
Spectrum from_sun_patch(const Problem& problem, const SunPatch& patch, const Vec3& p, const Vec3& n,
                        RandomStream& random) {
  const double a = random.uniform(), b = random.uniform(), c = random.uniform(), d = random.uniform();
  const double lift = problem.rays.lift();
  const Vec3 y{patch.x0 + a * (patch.x1 - patch.x0), patch.y0 + b * (patch.y1 - patch.y0), patch.z + lift};
  const Vec3 to = y - p;
  const double r2 = dot(to, to), r = std::sqrt(r2);
  const double cosines = dot(n, to) / r * (-to.z / r);
  if (!(dot(n, to) > 0 && to.z < 0)) return Spectrum(0.0);
  const Sun& sun = problem.lights.suns.front();
  const Vec3 to_sun = direction_to_sun(sun, c, d);
  const Spectrum arrives = problem.rays.transmittance(p, y);
  if (arrives.is_black()) return Spectrum(0.0);
  const Spectrum E_sun =
      sun.normal_irradiance * to_sun.z * problem.rays.transmittance(y, y + to_sun * (4 * problem.rays.diameter()));
  return patch.rho * E_sun * arrives * (patch.area() * cosines / (std::numbers::pi * r2));
}

/// As trace_path(), with the patch in place of the sun behind the first bounce.
Spectrum trace_path(const Illumination& light, const SunPatch& patch, Vec3 p, Vec3 n, const std::array<double, 2>& u,
                    RandomStream& random) {
  const Problem& problem = light.problem;
  Spectrum E = light.sampler.delta_light(p, n, {}, random.bits()), throughput(1.0);
  for (bool first = true;; first = false) {
    E += throughput * from_sun_patch(problem, patch, p, n, random);
    const double a = first ? u[0] : random.uniform(), b = first ? u[1] : random.uniform();
    const Vec3 d = cosine_direction(Frame(n), a, b);
    const Hit hit = problem.rays.first_hit(problem.patches, {p, d});
    if (hit.escaped() || !hit.patch.valid()) return E;
    throughput *= hit.transmittance * problem.patches.rho[hit.patch];
    const double survival = std::min(1.0, throughput.max());
    if (!(random.uniform() < survival)) return E;
    throughput *= 1 / survival;
    n = problem.patches.normal[hit.patch];
    p = p + d * static_cast<double>(hit.distance) + n * problem.rays.lift();
  }
}

double replicate(const Illumination& light, const std::optional<SunPatch>& patch, const Vec3& p, const Vec3& n,
                 std::uint64_t key) {
  unsigned long long rays = 0;
  Spectrum sum(0.0);
  for (int k = 0; k < Estimate::kPaths; ++k) {
    const auto u4 = sobol4(static_cast<std::uint32_t>(k), key);
    const std::array<double, 2> u{u4[0], u4[1]};
    RandomStream random(key, static_cast<std::uint64_t>(k));
    sum += patch ? trace_path(light, *patch, p, n, u, random)
                 : trace_path(light, p, n, path_start(u, static_cast<std::uint32_t>(k), key), random, rays);
  }
  return photometric(sum / Estimate::kPaths);
}

std::vector<Estimate> read_earlier(const std::string& file, std::size_t n) {
  std::vector<Estimate> estimates(n);
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) return estimates;
  for (Estimate& e : estimates) {
    if (!std::getline(in, line)) throw std::runtime_error(file + " belongs to other points; remove it");
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    double skipped, std_error;
    for (int k = 0; k < 6; ++k) row >> skipped;
    row >> e.mean >> std_error >> e.count;
    e.squares = std_error * std_error * static_cast<double>(e.count) * static_cast<double>(e.count - 1);
  }
  return estimates;
}

/// Written beside and renamed, so that a comparison may read it at any time.
void write(const std::string& file, const std::vector<SensorPoint>& points, const std::vector<Estimate>& estimates) {
  const std::string part = file + ".part";
  std::ofstream out(part);
  out.precision(10);
  out << "x,y,z,nx,ny,nz,illuminance,std_error,replicates\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& [p, n] = points[i];
    out << p.x << ',' << p.y << ',' << p.z << ',' << n.x << ',' << n.y << ',' << n.z << ',' << estimates[i].mean << ','
        << estimates[i].std_error() << ',' << estimates[i].count << '\n';
  }
  out.close();
  std::filesystem::rename(part, file);
}

double mean_of(const std::vector<Estimate>& estimates) {
  double sum = 0;
  for (const Estimate& e : estimates) sum += e.mean;
  return sum / static_cast<double>(estimates.size());
}

int run(const Arguments& arguments) {
  set_thread_count(arguments.threads);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const Scene scene = read_scene(arguments.scene);
  const std::vector<SensorPoint> points = read_sensors(arguments.points).points;
  const BareProblem bare(scene);
  const Problem& problem = bare.problem;
  const PatchSet& patches = problem.patches;
  const RayScene& rays = problem.rays;
  const Illumination light(problem);
  std::optional<SunPatch> patch = arguments.sun_patch;
  if (patch) {
    patch->x0 -= patches.origin.x, patch->x1 -= patches.origin.x;
    patch->y0 -= patches.origin.y, patch->y1 -= patches.origin.y;
    patch->z -= patches.origin.z;
    const Vec3 above{(patch->x0 + patch->x1) / 2, (patch->y0 + patch->y1) / 2, patch->z + 0.01};
    const Hit floor = rays.first_hit(patches, {above, {0, 0, -1}});
    if (!floor.patch.valid()) throw std::runtime_error("--sun-patch lies on no lit surface");
    patch->rho = patches.rho[floor.patch];
  }

  std::vector<Estimate> estimates = read_earlier(arguments.output, points.size());
  while (true) {
    const double mean = mean_of(estimates);
    const auto is_done = [&](const Estimate& e) {
      return e.count >= Estimate::kFewest && e.std_error() <= arguments.error * std::max(e.mean, mean) &&
             e.std_error() <= arguments.own_error * std::max(e.mean, 0.02 * mean);
    };
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!is_done(estimates[i])) open.push_back(i);
    double worst = 0;
    for (const Estimate& e : estimates) worst = std::max(worst, mean > 0 ? e.std_error() / mean : 1);
    std::fprintf(stderr, "%6.0f s  %zu points open, mean %.6g lx, largest standard error %.3f %% of it\n", seconds(),
                 open.size(), mean, 100 * worst);
    if (open.empty()) return 0;
    parallel_for(open.size(), 4, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) {
        const std::size_t i = open[k];
        const Vec3 n = points[i].normal, p = points[i].position - patches.origin + n * rays.lift();
        for (int r = 0; r < 4; ++r)
          estimates[i].add(
              replicate(light, patch, p, n, stream_key(0x7e5, i, static_cast<std::uint64_t>(estimates[i].count))));
      }
    });
    write(arguments.output, points, estimates);
    if (seconds() > arguments.seconds) return 4;
  }
}

SunPatch parse_sun_patch(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream in(text);
  SunPatch p{};
  if (!(in >> p.x0 >> p.y0 >> p.x1 >> p.y1 >> p.z)) throw std::runtime_error("--sun-patch wants five numbers");
  return p;
}

Arguments parse(int argc, char** argv) {
  Arguments a;
  if (argc < 4 || argc % 2 != 0) throw std::runtime_error(kUsage);
  a.scene = argv[1], a.points = argv[2], a.output = argv[3];
  for (int i = 4; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--error")
      a.error = std::stod(value);
    else if (option == "--own-error")
      a.own_error = std::stod(value);
    else if (option == "--seconds")
      a.seconds = std::stod(value);
    else if (option == "--threads")
      a.threads = std::stoi(value);
    else if (option == "--sun-patch")
      a.sun_patch = parse_sun_patch(value);
    else
      throw std::runtime_error(option + " is not known\n" + kUsage);
  }
  return a;
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  try {
    return clerestory::run(clerestory::parse(argc, argv));
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
