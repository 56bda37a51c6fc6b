#pragma once
// Small IFC files, written entity by entity.

#include <initializer_list>
#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Every add returns the reference of what was added, "#12". Lengths are metres, whatever the file's unit.
class IfcText {
 public:
  struct Options {
    std::string schema = "IFC4";
    std::string unit = "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)";
    double per_metre = 1;
    bool owner_history = false;  ///< IFC2X3 has one always
    Vec3 site{};
    std::string true_north = "$";  ///< "1.,1."
  };

  IfcText() : IfcText(Options{}) {}
  explicit IfcText(const Options& options) : schema_(options.schema), per_metre_(options.per_metre) {
    const std::string unit = add(options.unit);
    z_ = add("IFCDIRECTION((0.,0.,1.))");
    x_ = add("IFCDIRECTION((1.,0.,0.))");
    axes_ = placement({});
    const std::string north = options.true_north == "$" ? "$" : add("IFCDIRECTION((" + options.true_north + "))");
    context_ = add("IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05," + axes_ + "," + north + ")");
    if (options.owner_history || is_2x3()) {
      const std::string person = add("IFCPERSON($,$,'x',$,$,$,$,$)"), firm = add("IFCORGANIZATION($,'x',$,$,$)");
      const std::string both = add("IFCPERSONANDORGANIZATION(" + person + "," + firm + ",$)");
      const std::string program = add("IFCAPPLICATION(" + firm + ",'1','x','x')");
      owner_ = add("IFCOWNERHISTORY(" + both + "," + program + ",$,.ADDED.,$,$,$,0)");
    }
    const std::string units = add("IFCUNITASSIGNMENT((" + unit + "))");
    const std::string project = root("IFCPROJECT", "'p',$,$,$,$,(" + context_ + ")," + units);
    place_ = add("IFCLOCALPLACEMENT($," + placement(options.site) + ")");
    const std::string rest = ",$,$," + place_ + ",$,$,.ELEMENT.";
    const std::string site = root("IFCSITE", "'site'" + rest + ",$,$,$,$,$");
    const std::string building = root("IFCBUILDING", "'building'" + rest + ",$,$,$");
    storey_ = root("IFCBUILDINGSTOREY", "'ground'" + rest + ",0.");
    root("IFCRELAGGREGATES", "$,$," + project + ",(" + site + ")");
    root("IFCRELAGGREGATES", "$,$," + site + ",(" + building + ")");
    root("IFCRELAGGREGATES", "$,$," + building + ",(" + storey_ + ")");
  }

  const std::string& context() const { return context_; }
  bool is_2x3() const { return schema_ == "IFC2X3"; }

  std::string add(const std::string& entity) {
    lines_ += "#" + std::to_string(++count_) + "=" + entity + ";\n";
    return "#" + std::to_string(count_);
  }
  /// An entity that begins with a global id and an owner history.
  std::string root(const std::string& type, const std::string& rest) {
    std::string id = std::to_string(count_ + 1);
    id = std::string(22 - id.size(), '0') + id;
    return add(type + "('" + id + "'," + owner_ + "," + rest + ")");
  }

  std::string number(double metres) const { return std::to_string(metres * per_metre_); }
  std::string point(std::initializer_list<double> p) {
    std::string list;
    for (const double v : p) list += (list.empty() ? "" : ",") + number(v);
    return add("IFCCARTESIANPOINT((" + list + "))");
  }
  std::string placement(const Vec3& at) {
    return add("IFCAXIS2PLACEMENT3D(" + point({at.x, at.y, at.z}) + "," + z_ + "," + x_ + ")");
  }

  /// A block as an extruded rectangle.
  std::string box(const Vec3& lower, const Vec3& size) {
    const std::string middle = point({lower.x + size.x / 2, lower.y + size.y / 2});
    const std::string profile = add("IFCRECTANGLEPROFILEDEF(.AREA.,$," + add("IFCAXIS2PLACEMENT2D(" + middle + ",$)") +
                                    "," + number(size.x) + "," + number(size.y) + ")");
    return add("IFCEXTRUDEDAREASOLID(" + profile + "," + placement({0, 0, lower.z}) + "," + z_ + "," + number(size.z) +
               ")");
  }
  /// The same as triangles (IFC4).
  std::string triangles(const Vec3& lower, const Vec3& size) {
    return add(
        "IFCTRIANGULATEDFACESET(" + corner_list(lower, size) +
        ",$,.T.,((1,3,2),(2,3,4),(5,6,7),(6,8,7),(1,2,5),(2,6,5),(3,7,4),(4,7,8),(1,5,3),(3,5,7),(2,4,6),(4,8,6)),$)");
  }
  /// The same as polygons (IFC4).
  std::string polygons(const Vec3& lower, const Vec3& size) {
    const std::string corners = corner_list(lower, size);
    std::string faces;
    for (const char* face : {"1,3,4,2", "5,6,8,7", "1,2,6,5", "3,7,8,4", "1,5,7,3", "2,4,8,6"})
      faces += (faces.empty() ? "" : ",") + add("IFCINDEXEDPOLYGONALFACE((" + std::string(face) + "))");
    return add("IFCPOLYGONALFACESET(" + corners + ",.T.,(" + faces + "),$)");
  }
  /// The same as a boundary representation.
  std::string brep(const Vec3& lower, const Vec3& size) {
    std::vector<std::string> p;
    for (int c = 0; c < 8; ++c) {
      const Vec3 q = corner(lower, size, c);
      p.push_back(point({q.x, q.y, q.z}));
    }
    std::string faces;
    for (const auto& f :
         {std::vector{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
      std::string loop;
      for (const int c : f) loop += (loop.empty() ? "" : ",") + p[static_cast<std::size_t>(c)];
      const std::string bound = add("IFCFACEOUTERBOUND(" + add("IFCPOLYLOOP((" + loop + "))") + ",.T.)");
      faces += (faces.empty() ? "" : ",") + add("IFCFACE((" + bound + "))");
    }
    return add("IFCFACETEDBREP(" + add("IFCCLOSEDSHELL((" + faces + "))") + ")");
  }

  std::string shape(const std::string& items, const std::string& identifier = "Body") {
    return add("IFCSHAPEREPRESENTATION(" + context_ + ",'" + identifier + "','SweptSolid',(" + items + "))");
  }
  /// `representations`: references, or nothing; `rest`: the attributes behind them.
  std::string product(const std::string& type, const std::string& name, const std::string& representations,
                      const std::string& rest, const std::string& place = "") {
    const std::string shapes =
        representations.empty() ? "$" : add("IFCPRODUCTDEFINITIONSHAPE($,$,(" + representations + "))");
    return root(type, "'" + name + "',$,$," + (place.empty() ? place_ : place) + "," + shapes + "," + rest);
  }
  std::string element(const std::string& type, const std::string& name, const std::string& representations,
                      const std::string& rest) {
    const std::string added = product(type, name, representations, rest);
    contained_ += (contained_.empty() ? "" : ",") + added;
    return added;
  }
  std::string wall(const std::string& name, const std::string& item) {
    return element("IFCWALL", name, shape(item), is_2x3() ? "$" : "$,$");
  }
  std::string window(const std::string& name, const std::string& items) {
    return element("IFCWINDOW", name, shape(items), is_2x3() ? "1.,1." : "1.,1.,$,$,$");
  }
  void cut(const std::string& wall, const std::string& item) {
    const std::string opening = product("IFCOPENINGELEMENT", "o", shape(item), is_2x3() ? "$" : "$,.OPENING.");
    root("IFCRELVOIDSELEMENT", "$,$," + wall + "," + opening);
  }
  void space(const std::string& name, const std::string& long_name, const std::string& item) {
    product("IFCSPACE", name, item.empty() ? "" : shape(item), "'" + long_name + "',.ELEMENT.,.INTERNAL.,$");
  }
  /// A style, and the items that have it.
  /// gloss  SpecularColour and SpecularHighlight.
  std::string style(const std::string& name, const std::string& rgb, const std::string& transparency,
                    std::initializer_list<std::string> items, const std::string& gloss = "$,$") {
    const std::string look = add("IFCSURFACESTYLERENDERING(" + add("IFCCOLOURRGB($," + rgb + ")") + "," + transparency +
                                 ",$,$,$,$," + gloss + ",.NOTDEFINED.)");
    std::string style = add("IFCSURFACESTYLE('" + name + "',.BOTH.,(" + look + "))");
    if (is_2x3()) style = add("IFCPRESENTATIONSTYLEASSIGNMENT((" + style + "))");
    for (const std::string& item : items) add("IFCSTYLEDITEM(" + item + ",(" + style + "),$)");
    return style;
  }
  void material(const std::string& reference, const std::string& products) {
    root("IFCRELASSOCIATESMATERIAL", "$,$,(" + products + ")," + reference);
  }

  /// Floor, roof and four walls around 3.6 x 3.6 x 3 m; the south wall is returned, for a window.
  std::string room() {
    element("IFCSLAB", "floor", shape(box({0, 0, -0.2}, {4, 4, 0.2})), "$,.FLOOR.");
    element("IFCSLAB", "roof", shape(box({0, 0, 3}, {4, 4, 0.2})), "$,.ROOF.");
    wall("west", box({0, 0.2, 0}, {0.2, 3.6, 3}));
    wall("east", box({3.8, 0.2, 0}, {0.2, 3.6, 3}));
    wall("north", box({0, 3.8, 0}, {4, 0.2, 3}));
    return wall("south", box({0, 0, 0}, {4, 0.2, 3}));
  }

  std::string str() {
    if (!contained_.empty()) root("IFCRELCONTAINEDINSPATIALSTRUCTURE", "$,$,(" + contained_ + ")," + storey_);
    contained_.clear();
    return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
           "FILE_NAME('x.ifc','2026-01-01T00:00:00',(''),(''),'','','');\nFILE_SCHEMA(('" +
           schema_ + "'));\nENDSEC;\nDATA;\n" + lines_ + "ENDSEC;\nEND-ISO-10303-21;\n";
  }

 private:
  static Vec3 corner(const Vec3& lower, const Vec3& size, int c) {
    return {lower.x + (c & 1 ? size.x : 0), lower.y + (c & 2 ? size.y : 0), lower.z + (c & 4 ? size.z : 0)};
  }
  std::string corner_list(const Vec3& lower, const Vec3& size) {
    std::string list;
    for (int c = 0; c < 8; ++c) {
      const Vec3 p = corner(lower, size, c);
      list += (c ? ",(" : "(") + number(p.x) + "," + number(p.y) + "," + number(p.z) + ")";
    }
    return add("IFCCARTESIANPOINTLIST3D((" + list + "))");
  }

  std::string schema_, owner_ = "$", z_, x_, axes_, context_, place_, storey_, lines_, contained_;
  double per_metre_;
  int count_ = 0;
};

}  // namespace clerestory
