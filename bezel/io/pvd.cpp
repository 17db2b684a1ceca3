#include "bezel/io/pvd.hpp"

#include <fmt/format.h>

#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "bezel/base/atomic_file.hpp"
#include "bezel/base/error.hpp"
#include "bezel/io/cursor.hpp"
#include "bezel/io/xml.hpp"

namespace bezel {

std::vector<TimeStep> parse_pvd(const std::string& path, std::string_view bytes) {
  files::Xml xml(path, bytes);
  xml.parse(bytes);
  const pugi::xml_node root = xml.document().child("VTKFile");
  if (!root) xml.fail(0, "expected a VTKFile element at the top");
  const std::string type = root.attribute("type").value();
  if (type != "Collection")
    xml.fail(xml.line(root),
             fmt::format("a VTK file of type '{}', expected 'Collection'", files::shown(type)));
  const pugi::xml_node collection = xml.child(root, "Collection");
  std::vector<TimeStep> steps;
  std::set<double> times;
  for (const pugi::xml_node& node : collection.children("DataSet")) {
    TimeStep step;
    const std::string time = node.attribute("timestep").as_string("0");
    if (!files::parse_real(time, step.time) || !std::isfinite(step.time))
      xml.fail(xml.line(node), fmt::format("the time of step {} is '{}', expected a finite number",
                                           steps.size(), files::shown(time)));
    step.file = node.attribute("file").value();
    if (step.file.empty())
      xml.fail(xml.line(node), fmt::format("step {} names no file, expected one", steps.size()));
    if (!times.insert(step.time).second)
      xml.fail(xml.line(node), fmt::format("two files of time {}, expected one (a mesh in parts is "
                                           "not supported)",
                                           step.time));
    steps.push_back(std::move(step));
  }
  if (steps.empty()) xml.fail(xml.line(collection), "no DataSet element, expected at least one");
  return steps;
}

std::vector<TimeStep> read_pvd(const std::string& path) {
  const std::string bytes = read_file(path);
  return parse_pvd(path, bytes);
}

std::string encode_pvd(const std::vector<TimeStep>& steps) {
  if (steps.empty()) throw InputError("found no time step, expected at least one");
  pugi::xml_document document;
  pugi::xml_node root = document.append_child("VTKFile");
  root.append_attribute("type") = "Collection";
  root.append_attribute("version") = "1.0";
  root.append_attribute("byte_order") = "LittleEndian";
  pugi::xml_node collection = root.append_child("Collection");
  for (const TimeStep& step : steps) {
    if (!std::isfinite(step.time))
      throw InputError(fmt::format("the time of '{}' is {}, expected a finite number",
                                   files::shown(step.file), step.time));
    std::string time;
    files::append_number(time, step.time);
    pugi::xml_node node = collection.append_child("DataSet");
    node.append_attribute("timestep") = time.c_str();
    node.append_attribute("group") = "";
    node.append_attribute("part") = "0";
    node.append_attribute("file") = step.file.c_str();
  }
  std::ostringstream text;
  document.save(text, "  ");
  return text.str();
}

}  // namespace bezel
