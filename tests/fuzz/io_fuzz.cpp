#include "tests/fuzz/io_fuzz.hpp"

#include <cmath>
#include <stdexcept>

#include "bezel/base/error.hpp"
#include "bezel/io/msh.hpp"
#include "bezel/io/native.hpp"
#include "bezel/io/pvd.hpp"
#include "bezel/io/vtu.hpp"

namespace bezel::io_fuzz {

bool read_bytes(const std::string& bytes, int format) {
  try {
    if (format == 3) {
      for (const TimeStep& step : parse_pvd("fuzz.pvd", bytes))
        if (!std::isfinite(step.time) || step.file.empty())
          throw std::logic_error("a step without time or file");
      return true;
    }
    const Dataset data = format == 0   ? files::read_msh("fuzz.msh", bytes)
                         : format == 1 ? files::read_vtu("fuzz.vtu", bytes)
                                       : files::read_native("fuzz.bzl", bytes);
    if (!data.mesh) throw std::logic_error("a dataset without a mesh");
    for (const Vec2& p : data.mesh->control())
      if (!std::isfinite(p.x()) || !std::isfinite(p.y()))
        throw std::logic_error("a control point that is not finite");
    return true;
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.empty() || what.find('\n') != std::string::npos)
      throw std::logic_error("a message that is not one line: " + what);
    return false;
  }
}

}  // namespace bezel::io_fuzz
