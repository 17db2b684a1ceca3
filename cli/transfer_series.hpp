#pragma once
// bezel transfer on a time series, and what it shares with a single transfer.

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bezel/io/io.hpp"
#include "bezel/transfer/distributed.hpp"
#include "cli/context.hpp"
#include "cli/output.hpp"

namespace bezel::cli {

/// Whether the path ends in .pvd.
bool is_collection(const std::string& path);

/// The fields of those names, or all. @throws InputError naming the file
std::vector<Field> chosen_fields(const Dataset& data, const std::string& file,
                                 const std::vector<std::string>& names);

/// Calls transfer(); its errors name the file they are about.
TransferResult naming_files(const std::string& donor, const std::string& target,
                            const std::function<TransferResult()>& transfer);

struct SeriesFiles {
  std::string donor, target, out, report;
  std::vector<std::string> fields;
};
/// Moves the fields of every step; writes one .vtu file a step beside the collection `out`.
/// @param describe   the JSON object of one transfer
/// @param processes  that share the work, or null
int transfer_series(const SeriesFiles& files, const TransferOptions& options,
                    const std::function<Json(const TransferReport&)>& describe,
                    const Context& context, Processes* processes);

}  // namespace bezel::cli
