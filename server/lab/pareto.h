// Which choices are not beaten: nothing else is both cheaper and more exact.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace fts::lab {

struct CostAndError {
    double cost = 0.0, error = 0.0;
};

// Indices of the optimal ones, ascending in cost. Of equal ones the first. What is not a number is
// never optimal.
inline std::vector<std::size_t> pareto_front(const std::vector<CostAndError>& choices) {
    std::vector<std::size_t> order(choices.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::erase_if(order, [&](std::size_t i) {
        return !(choices[i].cost == choices[i].cost) || !(choices[i].error == choices[i].error);
    });
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const CostAndError &x = choices[a], &y = choices[b];
        return x.cost < y.cost || (x.cost == y.cost && x.error < y.error);
    });
    std::vector<std::size_t> front;
    double best = std::numeric_limits<double>::infinity();
    for (const std::size_t i : order) {
        if (choices[i].error >= best) continue;
        best = choices[i].error;
        front.push_back(i);
    }
    return front;
}

}  // namespace fts::lab
