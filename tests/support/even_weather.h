#pragma once
// A weather file of a whole year in which every day is alike, for tests of the program.

#include <sstream>
#include <string>

namespace clerestory {

/// Golden, Colorado: 500 W/m2 of the sun and 100 of the sky from 10 to 14 h each day, 1,460 h, and dark else. Hours
/// that have no light take no time.
inline std::string even_weather() {
  std::ostringstream out;
  out << "LOCATION,Golden,CO,USA,made up,0,39.742476,-105.1786,-7.0,1830.0\nDESIGN CONDITIONS,0\n"
         "TYPICAL/EXTREME PERIODS,0\nGROUND TEMPERATURES,0\nHOLIDAYS/DAYLIGHT SAVINGS,No,0,0,0\nCOMMENTS 1,made up\n"
         "COMMENTS 2,\nDATA PERIODS,1,1,Data,Sunday,1/1,12/31\n";
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  for (int month = 1; month <= 12; ++month)
    for (int day = 1; day <= kDays[month - 1]; ++day)
      for (int hour = 1; hour <= 24; ++hour)
        out << "2003," << month << ',' << day << ',' << hour << ",0,?9?9,11.0,2.0,50,82000,0,0,300,"
            << (hour > 10 && hour <= 14 ? "400,500,100,999999,999999,999999,9999" : "0,0,0,0,0,0,0")
            << ",200,2.0,3,2,20.0,77777,9,999999999,12,0.12,0,88,0.2,0.0,0.0\n";
  return out.str();
}

}  // namespace clerestory
