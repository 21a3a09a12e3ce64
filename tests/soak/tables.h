#pragma once

#include <string>
#include <vector>

#include "tests/soak/robot.h"

namespace voxlist::soak {

/// The head of a table of times: states, errors, latencies, losses, CPU time, and the memory of
/// each service, in the order of their names.
std::string table_head(const Minute& of, const std::string& time_name);

/// One row of it. CPU time is for each second of the robot's; `minutes` is how many the row is of.
std::string table_row(const Minute& of, const std::string& time, std::size_t minutes);

/// A table of services: memory, CPU time and latencies, in one time and in a later one.
std::string service_table(const Minute& early, const Minute& late, std::size_t minutes);

/// A table of services over one time: CPU time for each second of the robot's, latencies.
std::string service_table(const Minute& of, std::size_t minutes);

/// What services lost and what troubled them, a line each; empty when nothing did.
std::string troubles_of(const Minute& of);

}  // namespace voxlist::soak
