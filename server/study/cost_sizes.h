// How the cost goes with size: the three meshes of the thesis with rigid links and without, and how the cost grows.
#ifndef PHRENIC_SERVER_STUDY_COST_SIZES_H_
#define PHRENIC_SERVER_STUDY_COST_SIZES_H_

#include <vector>

#include "phrenic/v1/study.pb.h"
#include "server/study/context.h"

namespace phrenic::study {

// Figures 5.10, 5.14-5.24 and 5.27, for the scenes that are like theirs: generated bodies are made anew with as many
// vertices as the thesis has, to about a hundredth; other bodies stand for the one size that comes nearest. The cube
// takes 100,000 steps a trial, as in the thesis. Nothing where the scene has no rigid links.
absl::Status AddSizes(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                      const Progress& progress, v1::CostTable& table);

// Sheets of springs up to the largest that is asked for, and the scene at each of the resolutions, all under the
// subject's integrator; the exponents.
absl::Status AddGrowth(const v1::CreateStudyRequest& request, const Subject& subject, const Compiler& compile,
                       const Progress& progress, v1::CostTable& table);

// A square sheet of springs of about as many vertices, under its weight and friction, held along one side. Edges of 1
// cm whatever its size.
v1::Scene SheetOf(int vertices);

// The exponent p of cost ~ vertices^p by least squares of the logarithms; 0 for fewer than two sizes.
double FitExponent(const std::vector<double>& vertices, const std::vector<double>& costs);

}  // namespace phrenic::study

#endif  // PHRENIC_SERVER_STUDY_COST_SIZES_H_
