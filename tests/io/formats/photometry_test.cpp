#include "io/formats/photometry.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "io/formats/ies.h"
#include "io/formats/ldt.h"
#include "solver/model/error.h"
#include "tests/support/csv_rows.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

const std::filesystem::path kSamples = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "../shared/data/photometry";

PhotometricWeb read(const std::string& name) {
  std::vector<std::string> warnings;
  return read_photometry(kSamples / name, warnings);
}

/// A file of two planes' worth of numbers, kept small: labels, TILT and the rest as given.
std::string ies(const std::string& tail, const std::string& head = "IESNA:LM-63-2002\nTILT=NONE\n") {
  return head + tail;
}
PhotometricWeb parse(const std::string& bytes, std::vector<std::string>* said = nullptr) {
  std::vector<std::string> warnings;
  PhotometricWeb web = parse_ies(bytes, "lamp.ies", "", warnings);
  if (said) *said = warnings;
  return web;
}
std::string refusal(const std::string& bytes) {
  try {
    parse(bytes);
    return "(it was read)";
  } catch (const InputError& error) {
    return error.what();
  }
}
/// Direction of type C angles.
Vec3 towards(double gamma, double C) {
  const double g = gamma * std::numbers::pi / 180, c = C * std::numbers::pi / 180;
  return {std::sin(g) * std::cos(c), std::sin(g) * std::sin(c), -std::cos(g)};
}

const std::string kEvenly = "1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 100 100\n";

TEST(Photometry, EveryGoodSampleHasItsFluxAndPeakAndEveryBrokenOneIsRefusedWithItsLine) {
  if (!std::filesystem::exists(kSamples)) GTEST_SKIP() << "no ../shared/data beside this checkout";
  for (const auto& row : test::csv_rows(kSamples / "expected.csv")) {
    const std::string& name = row.at("file");
    if (row.at("expect") == "parse") {
      const PhotometricWeb web = read(name);
      // The same integral, computed by another program and printed with 8 digits; candelas here are floats.
      EXPECT_NEAR(luminous_flux(web) / std::stod(row.at("flux_lm")), 1, 1e-6) << name;
      EXPECT_NEAR(peak_candela(web) / std::stod(row.at("max_candela")), 1, 1e-6) << name;
    } else {
      try {
        read(name);
        ADD_FAILURE() << name << " was read";
      } catch (const InputError& error) {
        const std::string said = error.what(), file = std::filesystem::path(name).filename();
        EXPECT_NE(said.find(file + ":"), said.npos) << said;
      }
    }
  }
}

TEST(Photometry, LuminairesThatAreShippedGiveTheFluxTheirTableSays) {
  const std::filesystem::path folder = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "data" / "luminaires";
  for (const auto& [name, flux] :
       {std::pair{"classroom_linear.ies", 4200.0}, {"downlight.ies", 1500.0}, {"wallwasher.ies", 2000.0}}) {
    std::vector<std::string> warnings;
    EXPECT_NEAR(read_photometry(folder / name, warnings).flux, flux, 1e-4 * flux) << name;
    EXPECT_TRUE(warnings.empty()) << warnings.front();
  }
}

TEST(Photometry, SymmetryIsTakenFromTheAngles) {
  if (!std::filesystem::exists(kSamples)) GTEST_SKIP() << "no ../shared/data beside this checkout";
  EXPECT_EQ(read("synthetic/asymmetric_360.ies").symmetry, WebSymmetry::none);
  EXPECT_EQ(read("synthetic/bilateral_90_270.ies").symmetry, WebSymmetry::about_90_270);
  EXPECT_EQ(read("synthetic/isotropic_10000lm.ies").symmetry, WebSymmetry::rotational);
  EXPECT_EQ(read("synthetic/isym4_quadrant.ldt").symmetry, WebSymmetry::quadrants);
  EXPECT_EQ(read("synthetic/type_b_symmetric_flood.ies").symmetry, WebSymmetry::about_0_180);
}

TEST(Photometry, TheSideOfTypeBThatIsGivenIsMirroredToTheOther) {
  if (!std::filesystem::exists(kSamples)) GTEST_SKIP() << "no ../shared/data beside this checkout";
  const PhotometricWeb half = read("synthetic/type_b_symmetric_flood.ies"), whole = read("synthetic/type_b_flood.ies");
  EXPECT_EQ(half.horizontal, whole.horizontal);
  const Vec3 right = normalized({0.3, -0.4, -1}), left{right.x, -right.y, right.z};
  EXPECT_GT(candela_towards(half, right), 100);
  EXPECT_NEAR(candela_towards(half, right), candela_towards(half, left), 1e-9);
}

TEST(Photometry, SymmetryToC90C270IsStoredFromC270) {
  // The two synthetic files are one luminaire, strong to one side: to C0 in symmetry 2, to C90 in symmetry 3.
  if (!std::filesystem::exists(kSamples)) GTEST_SKIP() << "no ../shared/data beside this checkout";
  const PhotometricWeb to_c0 = read("synthetic/isym2_c0_c180.ldt"), to_c90 = read("synthetic/isym3_c90_c270.ldt");
  EXPECT_GT(candela_towards(to_c0, towards(45, 0)), 2.9 * candela_towards(to_c0, towards(45, 180)));
  for (const double C : {0.0, 37.0, 90.0, 200.0, 300.0})
    EXPECT_NEAR(candela_towards(to_c90, towards(45, C + 90)), candela_towards(to_c0, towards(45, C)), 1e-3) << C;
}

TEST(Photometry, AnLdtAndItsLm63TwinLightTheSameSide) {
  // Both shine to C0 only, 900 cd at gamma = 45; the LDT says it per 1,000 lm of 3,000.
  const std::string lm63 =
      "IESNA:LM-63-1995\nTILT=NONE\n1 3000 1 3 5 1 2 .6 1.2 0\n1 1 10\n0 45 90\n0 90 180 270 360\n"
      "0 900 0\n0 90 0\n0 0 0\n0 45 0\n0 900 0\n";
  std::string ldt =
      "maker\n2\n0\n4\n90\n3\n45\nreport\nname\nnumber\nfile\ndate\n1300\n700\n80\n1200\n600\n0\n0\n0\n0\n";
  ldt += "100\n9,3\n1\n0\n1\n1\nLED\n3000\n4000\n80\n30\n";
  for (int i = 0; i < 10; ++i) ldt += "0.5\n";
  ldt += "0\n90\n180\n270\n0\n45\n90\n0\n300\n0\n0\n30\n0\n0\n0\n0\n0\n15\n0\n";
  std::vector<std::string> warnings;
  const PhotometricWeb a = parse(lm63), b = parse_ldt(ldt, "lamp.ldt", warnings);
  for (const double C : {0.0, 30.0, 90.0, 180.0, 271.0, 359.0})
    EXPECT_NEAR(candela_towards(a, towards(45, C)), candela_towards(b, towards(45, C)), 1e-3) << C;
  EXPECT_NEAR(candela_towards(b, towards(45, 90)), 90, 1e-4);
  // Along C0: the length of LM-63, the width of EULUMDAT.
  EXPECT_EQ(a.opening.size, (Vec3{1.2, 0.6, 0}));
  EXPECT_EQ(b.opening.size, (Vec3{0.6, 1.2, 0}));
  EXPECT_NEAR(b.declared_flux, 279, 1e-9);
}

TEST(Photometry, EditionsDifferInTheNumberBehindTheBallastFactor) {
  const std::string numbers = "1 1000 2 3 1 1 2 0 0 0\n0.5 0.9 10\n0 45 90\n0\n100 100 100\n";
  EXPECT_FLOAT_EQ(parse(ies(numbers, "TILT=NONE\n")).candela[0], 90);  // 1986: no line that tells the edition
  EXPECT_FLOAT_EQ(parse(ies(numbers, "IESNA91\n[TEST] x\nTILT=NONE\n")).candela[0], 90);
  EXPECT_FLOAT_EQ(parse(ies(numbers, "IESNA:LM-63-1995\nTILT=NONE\n")).candela[0], 90);
  EXPECT_FLOAT_EQ(parse(ies(numbers, "IESNA:LM-63-2002\nTILT=NONE\n")).candela[0], 100);   // for future use
  EXPECT_FLOAT_EQ(parse(ies(numbers, "IES:LM-63-2019\n TILT = NONE\n")).candela[0], 100);  // how it was made
}

TEST(Photometry, WordsMayStandOnAnyLineWithAnySeparator) {
  const PhotometricWeb plain = parse(ies(kEvenly));
  const std::string odd =
      "\xef\xbb\xbfIESNA:LM-63-2002\r\n[MANUFAC] L\xfcster\r\nTILT=NONE\r\n1\r\n1000;1,3 1\t1 2 "
      "0,0\r\n0\r\n\r\n1;1\r\n10 0 "
      "45\r\n90\r\n0\r\n100,100\r\n1e2\r\n\x1a";
  EXPECT_EQ(parse(odd).candela, plain.candela);
  EXPECT_EQ(parse(odd).vertical, plain.vertical);
}

TEST(Photometry, NegativeLengthsOfTheOpeningSayRound) {
  const auto opening = [](const std::string& lengths) {
    return parse(ies("1 -1 1 2 1 1 1 " + lengths + "\n1 1 10\n0 90\n0\n1 1\n")).opening;
  };
  EXPECT_FALSE(opening("2 4 0").round);
  EXPECT_NEAR(opening("2 4 0.5").size.x, 4 * 0.3048, 1e-12);  // length lies along C0
  EXPECT_NEAR(opening("2 4 0.5").size.y, 2 * 0.3048, 1e-12);
  for (const char* disc : {"-1 0 0", "0 -1 0", "-1 -1 0"}) {
    EXPECT_TRUE(opening(disc).round) << disc;
    EXPECT_NEAR(opening(disc).size.x, 0.3048, 1e-12) << disc;
    EXPECT_NEAR(opening(disc).size.y, 0.3048, 1e-12) << disc;
  }
  EXPECT_NEAR(opening("-1 -1 -1").size.z, 0.3048, 1e-12);  // a sphere
  EXPECT_EQ(opening("0 0 0").size, Vec3{});
}

TEST(Photometry, TiltTablesAreReadInsideAndBeside) {
  const TempFolder folder;
  const std::string table = "1\n3\n0 45 90\n1 .9 .6\n", tail = kEvenly;
  const PhotometricWeb inside = parse(ies(table + tail, "IESNA:LM-63-2002\nTILT=INCLUDE\n"));
  EXPECT_DOUBLE_EQ(tilt_factor(inside, 0), 1);
  EXPECT_DOUBLE_EQ(tilt_factor(inside, 67.5), 0.75);
  EXPECT_DOUBLE_EQ(tilt_factor(inside, 180), 0.6);
  folder.write("lamp.tlt", table);
  const auto file = folder.write("lamp.ies", "IESNA:LM-63-2002\nTILT=lamp.tlt\n" + tail);
  std::vector<std::string> warnings;
  EXPECT_DOUBLE_EQ(tilt_factor(read_photometry(file, warnings), 67.5), 0.75);
  // Geometry 2: the lamp stays horizontal.
  EXPECT_DOUBLE_EQ(tilt_factor(parse(ies("2" + table.substr(1) + tail, "TILT=INCLUDE\n")), 67.5), 1);
}

TEST(Photometry, FluxIsTheExactIntegralOfLinearIntensity) {
  // 100 cd over the lower half: 200 pi. Falling from 100 cd at nadir to 0 at 90 degrees, linear in the angle:
  // 2 pi 100 (1 - 2 / pi).
  EXPECT_NEAR(luminous_flux(parse(ies(kEvenly))), 200 * std::numbers::pi, 1e-9);
  const PhotometricWeb ramp = parse(ies("1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 90\n0\n100 0\n"));
  EXPECT_NEAR(luminous_flux(ramp), 200 * std::numbers::pi * (1 - 2 / std::numbers::pi), 1e-9);
  // One candela in all directions of type A and B: half the sphere between +-90 degrees of both angles, 2 pi and 2 pi.
  for (const char* type : {"2", "3"})
    EXPECT_NEAR(luminous_flux(parse(ies(std::string("1 -1 1 3 3 ") + type +
                                        " 2 0 0 0\n1 1 10\n-90 0 90\n-90 0 90\n1 1 1 1 1 1 1 1 1\n"))),
                2 * std::numbers::pi, 1e-9);
}

TEST(Photometry, TypesAAndBCountTheirAnglesAsLm63Says) {
  // 100 cd at V = 0, H = 0 alone, and 50 at H = 45: to the right of the beam, seen from behind the luminaire.
  const auto web = [](const char* type) {
    return parse(ies(std::string("1 -1 1 5 5 ") + type +
                     " 2 0 0 0\n1 1 10\n-90 -45 0 45 90\n-90 -45 0 45 90\n0 0 0 0 0\n0 0 0 0 0\n0 0 100 70 0\n"
                     "0 0 50 0 0\n0 0 0 0 0\n"));
  };
  const double s = std::sqrt(0.5);
  const PhotometricWeb B = web("2"), A = web("3");
  EXPECT_NEAR(candela_towards(B, {0, 0, -1}), 100, 1e-6);  // V = 0 is straight down
  EXPECT_NEAR(candela_towards(B, {s, 0, -s}), 70, 1e-6);   // V goes up along the photometric horizontal, x
  EXPECT_NEAR(candela_towards(B, {0, -s, -s}), 50, 1e-6);  // H goes clockwise seen from above
  EXPECT_NEAR(candela_towards(A, {1, 0, 0}), 100, 1e-6);   // V = 0, H = 0 is the photometric horizontal
  EXPECT_NEAR(candela_towards(A, {s, 0, s}), 70, 1e-6);
  EXPECT_NEAR(candela_towards(A, {s, -s, 0}), 50, 1e-6);
}

TEST(Photometry, PlanesThatStopShortOf360CloseTheCircle) {
  std::vector<std::string> said;
  const PhotometricWeb web = parse(ies("1 -1 1 2 4 1 2 0 0 0\n1 1 10\n0 90\n0 90 180 270\n1 1 3 3 5 5 7 7\n"), &said);
  EXPECT_NEAR(candela_towards(web, towards(90, 315)), 4, 1e-5);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0], "lamp.ies: its horizontal angles end at 270 degrees; the plane of 0 is taken for 360");
}

TEST(Photometry, ALampThatGivesMoreThanItGetsIsReported) {
  std::vector<std::string> said;
  parse(ies("1 500 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 100 100\n"), &said);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0],
            "lamp.ies: its intensities add up to 628.3 lm, more than its lamps give, 500 lm; the intensities count");
}

TEST(Photometry, AMetersOffsetIsZeroAndTextBehindTheDataIsLeftOutBothWithAWarning) {
  const std::string head = "1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n";
  std::vector<std::string> said;
  EXPECT_EQ(parse(ies(head + "100 40 -0.1\n"), &said).candela, (std::vector<float>{100, 40, 0}));
  EXPECT_EQ(said, std::vector<std::string>{"lamp.ies: 1 intensity is negative, down to -0.1 cd; 0 is taken"});
  EXPECT_EQ(parse(ies(head + "100 -0 -4\n"), &said).candela, (std::vector<float>{100, 0, 0}));
  EXPECT_EQ(refusal(ies(head + "100\n40 -6\n")),
            "lamp.ies:8: candela at V = 90, H = 0 = -6 is negative, more than a meter's offset is; correct it, or take "
            "another file");
  EXPECT_EQ(refusal(ies(head + "-1 -1 -1\n")),
            "lamp.ies:7: candela at V = 0, H = 0 = -1 is negative, more than a meter's offset is; correct it, or take "
            "another file");
  for (const char* text : {"END\n", "[OTHER] measured in 2019 at 25 C\n", "# 3 4 5\n"}) {
    EXPECT_EQ(parse(ies(kEvenly + text), &said).candela, parse(ies(kEvenly)).candela);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(said[0].starts_with("lamp.ies:8: the text behind the data, '")) << said[0];
  }
  EXPECT_EQ(refusal(ies(kEvenly + "5 END\n")),
            "lamp.ies:8: 1 more number than 3 x 1 candelas; the counts of angles do not fit the data");

  std::string ldt = "maker\n1\n1\n1\n0\n3\n45\nreport\nname\nnumber\nfile\ndate\n100\n0\n0\n100\n0\n0\n0\n0\n0\n";
  ldt += "100\n100\n1\n0\n1\n1\nLED\n1000\n4000\n80\n30\n";
  for (int i = 0; i < 10; ++i) ldt += "0.5\n";
  ldt += "0\n0\n45\n90\n300\n100\n";
  said.clear();
  EXPECT_EQ(parse_ldt(ldt + "-0,1\nbye 7\n", "lamp.ldt", said).candela, (std::vector<float>{300, 100, 0}));
  ASSERT_GE(said.size(), 2u);
  EXPECT_EQ(said[0], "lamp.ldt: 1 intensity is negative, down to -0.1 cd; 0 is taken");
  EXPECT_EQ(said[1], "lamp.ldt:50: the text behind the data, 'bye ...', is left out");
  for (const char* wrong : {"-20\n", "1\n2\n"}) EXPECT_THROW(parse_ldt(ldt + wrong, "lamp.ldt", said), InputError);
}

TEST(Photometry, Utf16IsNamedWithTheWayOut) {
  std::string utf16 = "\xff\xfe";
  for (const char c : ies(kEvenly)) utf16 += c, utf16 += '\0';
  EXPECT_EQ(refusal(utf16), "lamp.ies: is UTF-16 text; save it as UTF-8");
}

TEST(Photometry, RefusalsNameLineValueAndWhatIsAllowed) {
  EXPECT_EQ(refusal(ies("1 1000 1 3 1 4 2 0 0 0\n")),
            "lamp.ies:3: photometric type = 4; 1 (C), 2 (B) and 3 (A) are known");
  EXPECT_EQ(refusal(ies("1 1000 1 2.5 1 1 2 0 0 0\n")),
            "lamp.ies:3: number of vertical angles = 2.5; a whole number in [2, 10000] is expected");
  EXPECT_EQ(refusal(ies("1 1000 0 3 1 1 2 0 0 0\n")),
            "lamp.ies:3: the multiplier of the candelas = 0; it must be positive");
  EXPECT_EQ(refusal(ies("1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 30\n")),
            "lamp.ies:5: vertical angles are not ascending: 30 follows 45");
  EXPECT_EQ(refusal(ies("1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 200\n")),
            "lamp.ies:5: vertical angle 3 of 3 = 200 is outside [0, 180] degrees");
  EXPECT_EQ(refusal(ies("1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n1 nan 1\n")),
            "lamp.ies:7: candela at V = 45, H = 0 = nan is out of every range");
  EXPECT_EQ(refusal(ies("1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n1 -2 1\n")),
            "lamp.ies:7: candela at V = 45, H = 0 = -2 is negative, more than a meter's offset is; correct it, or take "
            "another file");
  EXPECT_EQ(refusal(ies("1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n1 1\n")),
            "lamp.ies:7: the file ends before candela at V = 90, H = 0");
  EXPECT_EQ(refusal(ies(kEvenly + "5 6\n")),
            "lamp.ies:8: 2 more numbers than 3 x 1 candelas; the counts of angles do not fit the data");
  EXPECT_EQ(
      refusal(ies("1 1000 1 2 2 1 2 0 0 0\n1 1 10\n0 90\n0 77\n1 1 1 1\n")),
      "lamp.ies:6: horizontal angles go from 0 to 77; type C takes 0 alone, 0 to 90, 0 to 180, 90 to 270 or 0 to 360");
}

}  // namespace
}  // namespace clerestory
