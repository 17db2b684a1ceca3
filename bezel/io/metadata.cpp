#include "bezel/io/metadata.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"

namespace bezel::files {
namespace {

using nlohmann::json;

constexpr int metadata_version = 1;

int checked_int(const json& value, int lowest, int highest, const char* what) {
  if (!value.is_number_integer())
    throw InputError(std::string("bezel metadata: ") + what + " is not an integer");
  const auto n = value.get<std::int64_t>();
  if (n < lowest || n > highest)
    throw InputError(std::string("bezel metadata: ") + what + " is " + std::to_string(n) +
                     ", expected " + std::to_string(lowest) + " to " + std::to_string(highest));
  return static_cast<int>(n);
}

constexpr int most = std::numeric_limits<int>::max();

FieldMetadata field_from(const json& j) {
  FieldMetadata field;
  field.name = j.at("name").get<std::string>();
  field.components = checked_int(j.at("components"), 1, 9, "components");
  const json& degree = j.at("degree");
  if (degree.is_array()) {
    for (const json& d : degree)
      field.degrees.push_back(checked_int(d, 0, Space::max_degree, "degree"));
  } else {
    field.degrees.push_back(checked_int(degree, 0, Space::max_degree, "degree"));
  }
  if (field.degrees.empty()) throw InputError("bezel metadata: degree is empty");
  const auto basis = j.at("basis").get<std::string>();
  if (basis != "reference" && basis != "physical")
    throw InputError("bezel metadata: basis is not 'reference' or 'physical'");
  field.basis = basis == "physical" ? Basis::physical : Basis::reference;
  const auto continuity = j.at("continuity").get<std::string>();
  if (continuity != "continuous" && continuity != "discontinuous")
    throw InputError("bezel metadata: continuity is not 'continuous' or 'discontinuous'");
  field.continuity =
      continuity == "continuous" ? Continuity::continuous : Continuity::discontinuous;
  return field;
}

}  // namespace

const FieldMetadata* Metadata::field(const std::string& name) const {
  for (const FieldMetadata& f : fields)
    if (f.name == name) return &f;
  return nullptr;
}

Metadata describe(const Dataset& data) {
  Metadata metadata;
  metadata.degree = data.mesh->degree();
  metadata.time = data.time;
  metadata.tags.groups = data.mesh->tags().groups;
  metadata.tags.entities = data.mesh->tags().entities;
  metadata.has_element_entity = !data.mesh->tags().element_entity.empty();
  for (const Field& field : data.fields) {
    const Space& space = field.space();
    FieldMetadata f{field.name(), field.components(), {}, space.basis(), space.continuity()};
    if (space.uniform_degree() >= 0) {
      f.degrees.push_back(space.uniform_degree());
    } else {
      for (std::size_t e = 0; e < data.mesh->element_count(); ++e)
        f.degrees.push_back(space.degree(ElementId(e)));
    }
    metadata.fields.push_back(std::move(f));
  }
  return metadata;
}

std::string to_json(const Metadata& metadata) {
  json j;
  j["bezel"] = metadata_version;
  j["degree"] = metadata.degree;
  if (metadata.time) j["time"] = *metadata.time;
  j["groups"] = json::array();
  for (const PhysicalGroup& g : metadata.tags.groups)
    j["groups"].push_back({{"dim", g.dim}, {"tag", g.tag}, {"name", g.name}});
  j["entities"] = json::array();
  for (const Entity& e : metadata.tags.entities)
    j["entities"].push_back({{"dim", e.dim}, {"tag", e.tag}, {"physical", e.physical}});
  j["element_entity"] = metadata.has_element_entity;
  j["fields"] = json::array();
  for (const FieldMetadata& f : metadata.fields) {
    json field{
        {"name", f.name},
        {"components", f.components},
        {"basis", f.basis == Basis::physical ? "physical" : "reference"},
        {"continuity", f.continuity == Continuity::continuous ? "continuous" : "discontinuous"}};
    if (f.degrees.size() == 1) {
      field["degree"] = f.degrees[0];
    } else {
      field["degree"] = f.degrees;
    }
    j["fields"].push_back(std::move(field));
  }
  std::string text;
  try {
    text = j.dump(-1, ' ', true);
  } catch (const json::exception&) {
    throw InputError("a name of a field or physical group is not UTF-8 text");
  }
  // '$' starts sections of MSH files; in our JSON it occurs only inside strings.
  std::string out;
  for (const char c : text) {
    if (c == '$') {
      out += "\\u0024";
    } else {
      out += c;
    }
  }
  return out;
}

Metadata metadata_from_json(std::string_view text) {
  try {
    const json j = json::parse(text);
    Metadata metadata;
    checked_int(j.at("bezel"), metadata_version, metadata_version, "version");
    metadata.degree = checked_int(j.at("degree"), 1, TriangleMesh::max_degree, "geometric degree");
    if (j.contains("time")) {
      metadata.time = j.at("time").get<double>();
      if (!std::isfinite(*metadata.time)) throw InputError("bezel metadata: time is not finite");
    }
    for (const json& g : j.at("groups"))
      metadata.tags.groups.push_back({checked_int(g.at("dim"), 0, 3, "dim"),
                                      checked_int(g.at("tag"), -most, most, "tag"),
                                      g.at("name").get<std::string>()});
    for (const json& e : j.at("entities")) {
      Entity entity{
          checked_int(e.at("dim"), 0, 3, "dim"), checked_int(e.at("tag"), -most, most, "tag"), {}};
      for (const json& p : e.at("physical"))
        entity.physical.push_back(checked_int(p, -most, most, "physical group"));
      metadata.tags.entities.push_back(std::move(entity));
    }
    metadata.has_element_entity = j.at("element_entity").get<bool>();
    for (const json& f : j.at("fields")) metadata.fields.push_back(field_from(f));
    return metadata;
  } catch (const json::exception& error) {
    throw InputError(std::string("bezel metadata: ") + error.what());
  }
}

}  // namespace bezel::files
