#include "common/physics/solver_swept.h"

#include "common/physics/swept_engine.h"

namespace fts::physics {
namespace {

template <typename Scalar>
class SweptSolver final : public Solver<Scalar> {
  public:
    DriftReport<Scalar> drift(Bodies<Scalar>& bodies, const Model<Scalar>& model, Scalar span_s,
                              Record<Scalar>& record) override {
        if (!model.periodic) return open_.drift(bodies, model, span_s, record);
        if (!torus_) torus_ = std::make_unique<Torus>();
        return torus_->drift(bodies, model, span_s, record);
    }

  private:
    using Torus = SweptEngine<Scalar, TorusSpace<Scalar>>;

    SweptEngine<Scalar, OpenSpace<Scalar>> open_;
    std::unique_ptr<Torus> torus_;
};

}  // namespace

std::uint32_t event_budget(std::size_t bodies) {
    return kBaseEventBudget + kEventBudgetPerBody * static_cast<std::uint32_t>(bodies);
}

template <typename Scalar>
std::unique_ptr<Solver<Scalar>> make_swept_solver() {
    return std::make_unique<SweptSolver<Scalar>>();
}

template std::unique_ptr<Solver<double>> make_swept_solver();
template std::unique_ptr<Solver<float>> make_swept_solver();

}  // namespace fts::physics
