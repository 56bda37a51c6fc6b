#include "io/read_result.h"

#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "io/atomic_file.h"
#include "io/read_run_report.h"
#include "io/write_result.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

/// A triangle with light on both of its sides, far from the origin, in a room.
void write_sheet(
    const fs::path& file, const SceneAround& around = {},
    const std::function<void(PatchSet&)>& change = [](PatchSet&) {}, const LayeredLight& layers = {}) {
  PatchSet patches;
  patches.origin = {1e6, -2e6, 50};
  patches.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  patches.corners = {{VertexId{std::size_t{0}}, VertexId{std::size_t{1}}, VertexId{std::size_t{2}}}};
  patches.side_material = {{MaterialId{std::size_t{0}}, MaterialId{std::size_t{0}}}};
  patches.side_surface = {{SurfaceId{std::size_t{0}}, SurfaceId{std::size_t{0}}}};
  patches.materials.resize(1);
  patches.materials[0].name = "wall";
  patches.surfaces = {"sheet"};
  make_patches(patches, {true, true});
  patches.room = {1, 0}, patches.rooms = {"outdoors", "R1"};
  change(patches);
  Solution solution;
  solution.E = solution.B = Field(2, 3);
  VertexLightmap lightmap;
  lightmap.corners = {{0, 1, 2}, {3, 5, 4}};
  lightmap.position = patches.vertices;
  lightmap.position.insert(lightmap.position.end(), patches.vertices.begin(), patches.vertices.end());
  lightmap.patch_of_point = {0, 0, 0, 1, 1, 1};
  lightmap.E = Field(6, 3);
  for (std::size_t i = 0; i < 6; ++i) lightmap.E.set(i, Spectrum(1.0 + static_cast<double>(i)));
  RunReport report = new_report("sheet.obj");
  report.layers = around.layers;
  report.repairs.input_faces = 3, report.repairs.worst_angle_deg = 36.87, report.counts.clusters = 5;
  report.settings = {{"seed", 7LL}, {"max_element", 2.0}};
  AtomicFile whole(file);
  write_result(whole, patches, lightmap, solution, around, report, layers);
  whole.commit();
}

/// Of two layers, "a, b" and "sky", on the sheet.
LayeredLight layered_light() {
  LayeredLight light{Field(6, 6), Field(2, 6), Field(6, 6), Field(2, 6)};
  for (Field* field : {&light.E, &light.E_elements, &light.B, &light.B_elements})
    for (std::size_t k = 0; k < field->value.size(); ++k) field->value[k] = 0.5 + static_cast<double>(k);
  return light;
}
SceneAround around_layers() {
  SceneAround around;
  SkyTable sky;
  sky.radiance = Field(SkyTable::kRows * SkyTable::kColumns, 3);
  sky.radiance.set(7, {0.5, 0.25, 2});
  around.layers = {{"a, b", {1, 2, 3}, {}, 0.5}, {"sky", {4, 5, 6}, sky, 1}};
  Field lanes(2, 6);
  for (std::size_t k = 0; k < lanes.value.size(); ++k) lanes.value[k] = 1.0 / (1.0 + static_cast<double>(k));
  around.sensors = {{{"desk", {{{1, 2, 3}, {0, 0, 1}}, {{4, 5, 6}, {0, 1, 0}}}}, {7, 8}, lanes}};
  return around;
}

TEST(ReadResult, BringsBackWhatWasWritten) {
  const TempFolder folder;
  write_sheet(folder / "a.vtp");
  const WrittenResult r = read_result(fs::path(folder / "a.vtp"));
  ASSERT_EQ(r.points.size(), 6u);
  EXPECT_EQ(r.points[1].x, 1e6 + 3);
  EXPECT_EQ(r.points[1].y, -2e6);
  EXPECT_EQ(r.points[1].z, 50);
  EXPECT_EQ(r.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {3, 5, 4}}));
  EXPECT_EQ(r.of_points.at("irradiance").components, 3);
  EXPECT_EQ(r.of_points.at("irradiance").value.size(), 18u);
  for (std::size_t i = 0; i < 6; ++i)  // 179 lm/W, and the weights of the channels sum to 1
    EXPECT_FLOAT_EQ(r.of_points.at("illuminance").value[i], 179 * (1 + static_cast<float>(i)));
  EXPECT_EQ(r.of_cells.at("room").value, (std::vector<float>{1, 0}));
  EXPECT_EQ(r.rooms, (std::vector<std::string>{"outdoors", "R1"}));
  EXPECT_EQ(r.room, (std::vector<std::uint32_t>{1, 0}));
  EXPECT_EQ(r.surfaces, std::vector<std::string>{"sheet"});
  EXPECT_EQ(r.figures.at("residual"), 0);
  EXPECT_NE(r.report.find("\"input\":\"sheet.obj\""), std::string::npos) << r.report;
}

TEST(ReadResult, BringsBackWhatIsAroundTheSurfaces) {
  const TempFolder folder;
  SceneAround around;
  around.daylight_reference = 10'000;
  around.panes = {{{Vec3{0, 0, 1}, Vec3{1e6, 0, 1}, Vec3{0, 1, 1.25}}, 0, 0}};
  around.sky.radiance = Field(SkyTable::kRows * SkyTable::kColumns, 3);
  around.sky.radiance.set(7, {0.5, 0.25, 2});
  around.sensors = {{{"desk", {{{1, 2, 3}, {0, 0, 1}}, {{4, 5, 6}, {0, 1, 0}}}, SensorKind::vertical, 500.0}, {7, 8}},
                    {{"floor", {{{9, 9, 9}, {0, 0, 1}}}, SensorKind::planar, {}}, {1.0 / 3}}};
  around.luminaires = {{{1, 1, 2.5}, "spot", "ceiling", 800}, {{3, 1, 2.5}, "", "", 400}};
  write_sheet(folder / "a.vtp", around);
  const WrittenResult r = read_result(fs::path(folder / "a.vtp"));
  EXPECT_EQ(r.around.daylight_reference, 10'000);
  ASSERT_EQ(r.around.panes.size(), 1u);
  EXPECT_EQ(r.around.panes[0].corners, around.panes[0].corners);
  EXPECT_EQ(r.around.sky.radiance[7], (Spectrum{0.5, 0.25, 2}));
  ASSERT_EQ(r.around.sensors.size(), 2u);
  const MeasuredSensors& desk = r.around.sensors[0];
  EXPECT_EQ(desk.set.name, "desk");
  EXPECT_EQ(desk.set.kind, SensorKind::vertical);
  EXPECT_EQ(desk.set.threshold, 500.0);
  EXPECT_EQ(desk.set.points[1].position, (Vec3{4, 5, 6}));
  EXPECT_EQ(desk.set.points[1].normal, (Vec3{0, 1, 0}));
  EXPECT_EQ(desk.illuminance, (std::vector<double>{7, 8}));
  EXPECT_FALSE(r.around.sensors[1].set.threshold);
  EXPECT_EQ(r.around.sensors[1].illuminance, (std::vector<double>{1.0 / 3})) << "double, as written";
  ASSERT_EQ(r.around.luminaires.size(), 2u);
  EXPECT_EQ(r.around.luminaires[0].group, "ceiling");
  EXPECT_EQ(r.around.luminaires[1].luminous_flux, 400);
}

TEST(ReadResult, BringsBackTheLayers) {
  const TempFolder folder;
  const SceneAround around = around_layers();
  const LayeredLight light = layered_light();
  write_sheet(
      folder / "a.vtp", around, [](PatchSet&) {}, light);
  const WrittenResult r = read_result(fs::path(folder / "a.vtp"));
  ASSERT_EQ(r.around.layers.size(), 2u);
  const ShownLayer &first = r.around.layers[0], &sky = r.around.layers[1];
  EXPECT_EQ(first.name, "a, b");
  EXPECT_EQ(first.energy.absorbed, 2);
  EXPECT_EQ(first.factor, 0.5);
  EXPECT_TRUE(first.sky.empty());
  EXPECT_EQ(sky.sky.radiance[7], (Spectrum{0.5, 0.25, 2}));
  EXPECT_EQ(r.of_points.at("irradiance:sky").components, 3);
  EXPECT_EQ(r.of_points.at("irradiance:sky").value[3], 9.5f) << "lane 3 of the second point's six is 6 + 3";
  EXPECT_EQ(r.of_cells.at("radiosity:a, b").value[1], 1.5f);
  const auto E = r.of_points.at("irradiance:a, b").value;
  EXPECT_FLOAT_EQ(r.of_points.at("illuminance:a, b").value[0], static_cast<float>(photometric({E[0], E[1], E[2]})));
  ASSERT_EQ(r.around.sensors.size(), 1u);
  EXPECT_EQ(r.around.sensors[0].layers.value, around.sensors[0].layers.value) << "double, as written";
}

TEST(ReadResult, WhatIsReadAndWrittenAgainIsTheSameFile) {
  const TempFolder folder;
  for (const bool layered : {false, true}) {
    SceneAround around = layered ? around_layers() : SceneAround();
    around.daylight_reference = 10'000;
    around.luminaires = {{{1, 1, 2.5}, "spot", "ceiling", 800}};
    write_sheet(
        folder / "a.vtp", around, [](PatchSet&) {}, layered ? layered_light() : LayeredLight());
    const WrittenResult r = read_result(fs::path(folder / "a.vtp"));
    AtomicFile again(folder / "b.vtp");
    write_result(again, r, run_report_of(r.report, r.file));
    again.commit();
    EXPECT_TRUE(read_text(folder / "a.vtp") == read_text(folder / "b.vtp")) << layered;
  }
}

TEST(ReadResult, RefusesALayerWithoutItsLight) {
  const TempFolder folder;
  SceneAround around = around_layers();
  write_sheet(
      folder / "a.vtp", around, [](PatchSet&) {}, layered_light());
  std::string text = read_text(folder / "a.vtp");
  for (std::size_t at = 0; (at = text.find("irradiance:sky", at)) != text.npos;) text.replace(at, 14, "irradiance:sun");
  const fs::path file = folder.write("b.vtp", text);
  try {
    read_result(file);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("an array 'irradiance:sky' of 3 components"), std::string::npos) << e.what();
  }
}

std::string refused(const fs::path& file) {
  try {
    read_result(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(ReadResult, RefusesWhatNoSceneHolds) {
  const TempFolder folder;
  const auto refusal = [&](const std::function<void(PatchSet&)>& change) {
    write_sheet(folder / "a.vtp", {}, change);
    return refused(fs::path(folder / "a.vtp"));
  };
  EXPECT_EQ(refusal([](PatchSet&) {}), "");
  EXPECT_NE(refusal([](PatchSet& p) { p.origin.x = 1e14; }).find("point 0 has the coordinate 1e+14"),
            std::string::npos);
  EXPECT_NE(
      refusal([](PatchSet& p) { p.materials[0].reflectance = Spectrum(1.5); }).find("its material 'wall' reflects 1.5"),
      std::string::npos);
}

TEST(ReadResult, RefusesWhatNoSolveWroteAndSaysWhy) {
  const TempFolder folder;
  write_sheet(folder / "a.vtp");
  const std::string whole = read_text(folder / "a.vtp");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
      text.replace(at, from.size(), to);
    EXPECT_NE(text, whole) << from;
    return fs::path(folder.write("b.vtp", text));
  };
  EXPECT_NE(refused(folder / "none.vtp").find("none.vtp"), std::string::npos);
  EXPECT_NE(refused(folder.write("t.vtp", "no picture")).find("t.vtp: is no VTK PolyData"), std::string::npos);
  EXPECT_NE(refused(folder.write("c.vtp", whole.substr(0, whole.size() / 2))).find("c.vtp: is damaged"),
            std::string::npos);
  EXPECT_NE(refused(changed("\"illuminance\"", "\"luminosity\"")).find("no array 'illuminance'"), std::string::npos);
  EXPECT_NE(refused(changed("\"result_format\"", "\"other\"")).find("before results held what is needed"),
            std::string::npos);
  EXPECT_NE(refused(changed("\"material_kinds\"", "\"other\"")).find("unknown kind"), std::string::npos);
}

TEST(ReadResult, NamesTheNearestArrayWhenOneIsNotThere) {
  const TempFolder folder;
  write_sheet(folder / "a.vtp");
  const WrittenResult r = read_result(fs::path(folder / "a.vtp"));
  EXPECT_EQ(array_of_points(r, "illuminance").value.size(), 6u);
  try {
    array_of_points(r, "iluminance");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'illuminance'?"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace clerestory
