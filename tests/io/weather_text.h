#pragma once
// Weather files for tests: one day of invented values, and ways to spoil them.

#include <sstream>
#include <string>
#include <vector>

namespace clerestory {

/// A day in Golden, Colorado, 17 October 2003. Hour 13 has 600 and 120 W/m2, 62,000 and 16,000 lx; other hours of the
/// day 500 and 100 W/m2 without illuminances; hour 15 lacks its direct radiation; nights are dark.
inline std::vector<std::string> weather_lines() {
  std::vector<std::string> lines = {"LOCATION,Golden,CO,USA,made up,0,39.742476,-105.1786,-7.0,1830.0",
                                    "DESIGN CONDITIONS,0",
                                    "TYPICAL/EXTREME PERIODS,0",
                                    "GROUND TEMPERATURES,0",
                                    "HOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0",
                                    "COMMENTS 1,made up",
                                    "COMMENTS 2,",
                                    "DATA PERIODS,1,1,Data,Friday,10/17,10/17"};
  for (int hour = 1; hour <= 24; ++hour) {
    std::string light = "0,0,0,0,0,0,0";
    if (hour >= 7 && hour <= 18) light = "400,500,100,999999,999999,999999,9999";
    if (hour == 13) light = "500,600,120,64000,62000,16000,9999";
    if (hour == 15) light = "9999,9999,100,999999,999999,999999,9999";
    std::ostringstream line;
    line << "2003,10,17," << hour << ",0,?9?9,11.0,2.0,50,82000,0,0,300," << light
         << ",200,2.0,3,2,20.0,77777,9,999999999,12,0.12,0,88,0.2,0.0,0.0";
    lines.push_back(line.str());
  }
  return lines;
}

inline std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

}  // namespace clerestory
