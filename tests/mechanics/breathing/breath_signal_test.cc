// The signal of breaths: continuous, between its bounds, and with the derivative that it states.
#include "server/mechanics/breath_signal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/schema/schema.h"

namespace phrenic {
namespace {

v1::Parameters Shares(double inspiratory, double pause, double waxing = 0) {
  v1::Parameters parameters;
  schema::FillDefaults(&parameters);
  parameters.set_inspiratory_share(inspiratory);
  parameters.set_pause_share(pause);
  parameters.set_waxing(waxing);
  return parameters;
}

v1::Breath Of(v1::Waveform waveform) {
  v1::Breath breath;
  breath.set_waveform(waveform);
  for (const double value : {0.0, 0.3, 0.9, 1.0, 0.6, 0.2}) breath.add_trace(value);
  return breath;
}

TEST(BreathSignal, SlopeIsItsDerivative) {
  constexpr double kStep = 1e-6;
  for (const auto waveform : {v1::WAVEFORM_SINE, v1::WAVEFORM_RAISED_COSINE, v1::WAVEFORM_TRACE}) {
    for (const auto& parameters : {Shares(0.5, 0), Shares(0.3, 0.2), Shares(0.15, 0.6, 1), Shares(0.9, 0.9)}) {
      for (double phase = 0.01234567; phase < 13; phase += 0.03172345) {  // at no corner of a signal
        const auto at = [&](double offset) { return BreathSignalAt(Of(waveform), parameters, phase + offset).value; };
        const double slope = BreathSignalAt(Of(waveform), parameters, phase).slope;
        EXPECT_NEAR((at(kStep) - at(-kStep)) / (2 * kStep), slope, 1e-3 * (1 + std::abs(slope))) << phase;
      }
    }
  }
}

TEST(BreathSignal, StaysWithinItsBounds) {
  for (const auto waveform : {v1::WAVEFORM_RAISED_COSINE, v1::WAVEFORM_TRACE}) {
    for (double phase = 0; phase < 24; phase += 0.01) {
      const BreathSignal signal = BreathSignalAt(Of(waveform), Shares(0.4, 0.3, 0.7), phase);
      EXPECT_GE(signal.value, 0);
      EXPECT_LE(signal.value, 1);
      EXPECT_GE(signal.expiration, 0);
      EXPECT_LE(signal.expiration, 1);
    }
  }
}

TEST(BreathSignal, RisesOverTheInspiratoryShareAndRestsInThePause) {
  const auto value = [](double phase) {
    return BreathSignalAt(Of(v1::WAVEFORM_RAISED_COSINE), Shares(0.25, 0.4), phase).value;
  };
  EXPECT_NEAR(value(0.125), 0.5, 1e-12);
  EXPECT_NEAR(value(0.25), 1, 1e-12);
  EXPECT_NEAR(value(0.425), 0.5, 1e-12);
  EXPECT_EQ(value(0.7), 0);
  EXPECT_EQ(value(3.99), 0);
}

TEST(BreathSignal, TheGlottisClosesAtThePeakForItsShare) {
  v1::Parameters cough = Shares(0.5, 0.4);
  const auto closed = [&](double phase) {
    return BreathSignalAt(Of(v1::WAVEFORM_RAISED_COSINE), cough, phase).glottis_closed;
  };
  EXPECT_FALSE(closed(0.55));
  cough.set_glottis_share(0.1);
  EXPECT_FALSE(closed(0.49));
  EXPECT_TRUE(closed(0.51));
  EXPECT_TRUE(closed(7.59));
  EXPECT_FALSE(closed(7.61));
  EXPECT_FALSE(BreathSignalAt(Of(v1::WAVEFORM_SINE), cough, 0.51).glottis_closed);
}

TEST(BreathSignal, WanesToNothingInTheMiddleOfTwelveBreaths) {
  const auto value = [](double phase) {
    return BreathSignalAt(Of(v1::WAVEFORM_RAISED_COSINE), Shares(0.5, 0, 1), phase).value;
  };
  EXPECT_GT(value(0.5), 0.95);
  EXPECT_LT(value(5.5), 0.02);
  EXPECT_GT(value(11.5), 0.95);
}

}  // namespace
}  // namespace phrenic
