// bezel sample: formulas as fields on a mesh.

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "bezel/base/error.hpp"
#include "cli/arguments.hpp"
#include "cli/output.hpp"

namespace bezel::cli {
namespace {

struct SampleOptions {
  std::string mesh, out, continuity = "dg";
  std::vector<std::string> fields;
  std::optional<int> degree;
  Basis basis = Basis::reference;
  bool project = false;
  std::optional<Format> format;
};

Field make_field(const SampleOptions& options, const NamedFormulas& f,
                 const std::shared_ptr<const Space>& space, int threads) {
  try {
    return options.project ? project(f.name, space, f.components, 6, threads)
                           : sample(f.name, space, f.components, threads);
  } catch (const InputError& error) {
    throw error.in_file(options.mesh);
  }
}

int run(const SampleOptions& options, const Context& context) {
  WriteOptions how;
  how.format = options.format ? options.format : format_of(options.out);
  std::vector<NamedFormulas> wanted;
  for (const std::string& text : options.fields) {
    wanted.push_back(parse_named_formulas(text));
    const auto same = [&](const NamedFormulas& f) { return f.name == wanted.back().name; };
    if (std::count_if(wanted.begin(), wanted.end(), same) > 1)
      throw UsageError("-f: two fields are named '" + wanted.back().name + "'");
  }
  const bool continuous = options.continuity == "cg";
  if (continuous && options.basis == Basis::physical) {
    throw UsageError(
        "--continuity cg: continuous fields need the reference basis (polynomials in x and y do "
        "not join continuously across curved edges)");
  }
  require_writable(options.out);

  Dataset data = read_noting(context, options.mesh);
  const int degree = options.degree.value_or(data.mesh->degree());
  const auto space = continuous ? Space::continuous(data.mesh, degree)
                                : Space::discontinuous(data.mesh, degree, options.basis);
  Json fields = Json::array();
  for (const NamedFormulas& f : wanted) {
    Field field = make_field(options, f, space, context.threads);
    fields.push_back({{"name", f.name},
                      {"components", field.components()},
                      {"integral", per_component(integral(field, context.threads))}});
    const auto old = std::find_if(data.fields.begin(), data.fields.end(),
                                  [&](const Field& k) { return k.name() == f.name; });
    if (old == data.fields.end()) {
      data.fields.push_back(std::move(field));
    } else {
      *old = std::move(field);
      note(context, options.mesh + ": field '" + f.name + "' is replaced");
    }
  }
  const std::vector<std::string> lost = write(options.out, data, how);
  notes(context, options.out, lost);
  if (context.json) {
    print_or_remove(to_text(Json{{"schema", "bezel/sample/1"},
                                 {"output", options.out},
                                 {"elements", data.mesh->element_count()},
                                 {"degree", degree},
                                 {"basis", to_string(options.basis)},
                                 {"continuity", to_string(space->continuity())},
                                 {"dofs", space->dof_count()},
                                 {"fields", fields},
                                 {"lost", lost}}),
                    {options.out});
  }
  return ok;
}

}  // namespace

void add_sample(CLI::App& app, Context& context) {
  auto options = std::make_shared<SampleOptions>();
  SampleOptions& o = *options;
  CLI::App* command = add_command(
      app, context, "sample", "Put formulas of x and y on a mesh as fields",
      "bezel sample disc.msh -f 'u=exp(x^2)+2*y' -f 'flow=-y;x' --degree 3 -o donor.msh", options,
      run);
  command->add_option("MESH", o.mesh, "Mesh file; fields it holds are kept")->required();
  command
      ->add_option("-f,--field", o.fields, "A field; components separated by ';'. May be repeated")
      ->required()
      ->allow_extra_args(false)
      ->type_name("NAME=EXPR");
  command->add_option("-o,--output", o.out, "File to write")->required()->type_name("FILE");
  command
      ->add_option("--degree", o.degree,
                   "Degree of the fields, 0 to 10; default: the mesh's geometric degree")
      ->check(CLI::Range(0, 10))
      ->type_name("P");
  add_basis_option(*command, o.basis, "reference (mapped) or physical (polynomials in x and y)");
  command->add_option("--continuity", o.continuity, "dg (discontinuous) or cg (continuous)")
      ->check(CLI::IsMember({"cg", "dg"}))
      ->type_name("CONTINUITY")
      ->capture_default_str();
  command->add_flag("--project", o.project, "L2 projection instead of interpolation");
  add_format_option(*command, o.format, "--format", "Format; default: by the extension");
}

}  // namespace bezel::cli
