// bezel convert: from one file format to another.

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "cli/arguments.hpp"
#include "cli/output.hpp"

namespace bezel::cli {
namespace {

struct ConvertOptions {
  std::string in, out;
  std::optional<Format> from;
  WriteOptions write;
  bool no_compress = false;
};

int run(const ConvertOptions& options, const Context& context) {
  WriteOptions how = options.write;
  if (!how.format) how.format = format_of(options.out);
  how.compress = !options.no_compress;
  require_writable(options.out);
  const Dataset data = read_noting(context, options.in, options.from);
  const std::vector<std::string> lost = write(options.out, data, how);
  notes(context, options.out, lost);
  if (context.json) {
    print_or_remove(to_text(Json{{"schema", "bezel/convert/1"},
                                 {"input", options.in},
                                 {"output", options.out},
                                 {"format", bezel::to_string(*how.format)},
                                 {"elements", data.mesh->element_count()},
                                 {"fields", data.fields.size()},
                                 {"not_read", data.notes},
                                 {"lost", lost}}),
                    {options.out});
  }
  return ok;
}

}  // namespace

void add_convert(CLI::App& app, Context& context) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command =
      add_command(app, context, "convert", "Convert between file formats, saying what was lost",
                  "bezel convert wing.msh wing.vtu", options, run);
  command->add_option("IN", options->in, "File to read")->required();
  command->add_option("OUT", options->out, "File to write")->required();
  add_format_option(*command, options->from, "--from",
                    "Format of IN, when its extension does not say");
  add_format_option(*command, options->write.format, "--format",
                    "Format of OUT; default: by its extension (.msh: msh41_binary)");
  command->add_flag("--bezier-cells", options->write.bezier_cells,
                    "VTU: Bezier cells instead of Lagrange cells");
  command->add_flag("--no-compress", options->no_compress, "VTU: data not compressed");
}

}  // namespace bezel::cli
