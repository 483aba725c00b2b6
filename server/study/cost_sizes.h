// Cost as a function of size: the meshes of the thesis with and without rigid links, and the growth exponent.
#ifndef PHRENIC_SERVER_STUDY_COST_SIZES_H_
#define PHRENIC_SERVER_STUDY_COST_SIZES_H_

#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"
#include "server/study/cost_budget.h"

namespace phrenic::study {

// Appends rows that reproduce figures 5.10, 5.14-5.24 and 5.27 of the thesis, for scenes of the same kind. Generated
// bodies are meshed again with the thesis' numbers of vertices, within about 1 %; other bodies are compared with the
// nearest size only. The cube takes 100,000 steps per trial, as in the thesis. Adds nothing if the scene has no rigid
// links. Leaves out, and notes, the sizes whose meshes do not fit into the budget. Errors: those of the compile step;
// CANCELLED if `progress` returns false.
absl::Status AddSizes(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                      CostBudget& budget, const Progress& progress, v1::CostTable& table);

// Appends the cost of sheets of springs up to the requested size and of the scene at each requested resolution, with
// the subject's integrator, and the growth exponents. Errors as for AddSizes.
absl::Status AddGrowth(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                       CostBudget& budget, const Progress& progress, v1::CostTable& table);

// Returns the scene of a square sheet of springs with about `vertices` vertices and edges of 1 cm, fixed along one
// side, under gravity and friction.
v1::Scene SheetOf(int vertices);

// Returns the exponent p of cost ~ vertices^p, a least-squares fit of the logarithms; 0 for fewer than two sizes.
double FitExponent(const std::vector<double>& vertices, const std::vector<double>& costs);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_SIZES_H_
