// SPDX-License-Identifier: BSD-3-Clause
#include "tools/series/hdf5_series.h"

#include <fmt/core.h>

#include <cmath>

#include "tools/hdf5/hdf5_input.h"
#include "tools/series/measured_table.h"

namespace cprsim {

namespace {

/// In SI units. @return how its numbers are called, empty if the file does not say
std::string to_si(const Hdf5Input& file, const std::string& array, std::vector<double>& values) {
  const std::string units = file.text(array, "units");
  const auto unit = si_unit(units);
  if (!units.empty() && !unit)
    throw TableError(fmt::format("the unit [{}] of {} is not known", units, array));
  for (double& value : values)
    value *= unit ? unit->factor : 1;
  return unit ? unit->name : "";
}

void require_increasing(const Series& series) {
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (std::isnan(series.time[i])) throw TableError(fmt::format("time[{}] is no number", i));
    if (i > 0 && series.time[i] <= series.time[i - 1])
      throw TableError(fmt::format("time does not increase at time[{}]", i));
  }
}

Series read(const std::string& path) {
  const Hdf5Input file(path);
  Series series;
  series.path = path;
  if (!file.has("time") || file.shape("time").size() != 1)
    throw TableError("the file has no array /time");
  series.time = file.numbers("time");
  to_si(file, "time", series.time);
  require_increasing(series);
  if (!file.has("channels")) throw TableError("the file has no group /channels");
  for (const std::string& name : file.names("channels")) {
    const std::string array = "channels/" + name;
    if (file.shape(array) != std::vector<std::size_t>{series.size()})
      throw TableError(
          fmt::format("{} has not one number for each of {} instants", array, series.size()));
    std::vector<double> values = file.numbers(array);
    const std::string unit = to_si(file, array, values);
    series.columns.push_back({name, unit, std::move(values)});
  }
  return series;
}

}  // namespace

Series read_hdf5_series(const std::string& path) {
  try {
    return read(path);
  } catch (const TableError& error) {
    throw TableError(path + ": " + error.what());
  } catch (const Hdf5Error& error) {
    throw TableError(path + ": not readable as HDF5: " + error.what());
  }
}

}  // namespace cprsim
