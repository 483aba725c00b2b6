// Every extreme case ends well: it passes, or it is stopped or refused with a reason.
#include "server/study/extremes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/study/subject.h"

namespace phrenic::study {
namespace {

using testing::HasSubstr;

const Progress kNobody = [](double, std::string_view) { return true; };

v1::StabilityTable Judge(const ExtremeCase& extreme) {
  v1::StabilityStudy study;
  study.set_most_seconds_a_run(120);
  v1::StabilityTable table;
  EXPECT_TRUE(AddExtreme(extreme, study, kNobody, table).ok());
  return table;
}

class Extremes : public testing::TestWithParam<ExtremeCase> {};

TEST_P(Extremes, EndWell) {
  const v1::StabilityTable table = Judge(GetParam());
  ASSERT_GT(table.extremes_size(), 0);
  for (const v1::ExtremeRow& row : table.extremes()) {
    std::printf("%s | %s | %s | %g | %g | %s\n", row.case_().c_str(), row.integrator().c_str(), row.verdict().c_str(), row.energy_ratio(), row.error_rms_mm(), row.note().c_str());
    EXPECT_NE(row.verdict(), "FAILED") << row.DebugString();
  }
}

std::string TestName(const testing::TestParamInfo<ExtremeCase>& info) {
  std::string name = info.param.name;
  std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, Extremes, testing::ValuesIn(ExtremeCases()), TestName);

}  // namespace
}  // namespace phrenic::study
