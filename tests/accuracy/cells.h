// What the study measures, cell by cell. A cell is one solver in one scene at one speed; its key
// says all that it depends on but the code.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "server/lab/accuracy.h"
#include "server/lab/setting.h"
#include "tests/accuracy/cell_store.h"

namespace fts::accuracy {

struct Cell {
    std::string key;
    // Null when stopped.
    std::function<Json(const lab::KeepGoing&)> measure;
};

// Those of which only time is measured are best made alone on the machine.
struct StudyCells {
    std::vector<Cell> accuracy, cost;
};

StudyCells all_cells();

// The axes of the study.
const std::vector<double>& speeds();         // radii per tick
const std::vector<double>& coarse_speeds();  // of scenes other than the medium gas
const std::vector<std::uint32_t>& substeps();
std::vector<lab::Setting> all_settings();
std::vector<lab::Setting> drift_settings();
std::vector<lab::Setting> divergence_settings();
std::vector<lab::Setting> size_settings();
const std::vector<std::size_t>& divergence_sizes();
const std::vector<std::size_t>& cost_sizes();
inline constexpr std::uint64_t kDivergenceSeeds = 5;
inline constexpr double kExtremesSpeed = 0.1;

std::string accuracy_key(const std::string& scene, double speed, const lab::Setting& setting);
std::string cost_key(const std::string& scene, double speed, const lab::Setting& setting);
std::string drift_key(const lab::Setting& setting);
std::string divergence_key(std::size_t balls, std::uint64_t seed, const lab::Setting& setting);
std::string size_key(std::size_t balls, const lab::Setting& setting);

}  // namespace fts::accuracy
