// Bars, sparklines, wrapped text, durations and the live view.
#include <gmock/gmock.h>

#include "client/print/live_view.h"
#include "client/terminal/progress.h"
#include "client/terminal/sparkline.h"
#include "client/terminal/terminal.h"

namespace phrenic::client {
namespace {

TEST(Sparkline, GoesFromTheLowestToTheHighestBlock) {
  const std::vector<double> rising = {0, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_EQ(Sparkline(rising, 0, 7, true), "▁▂▃▄▅▆▇█");
  EXPECT_EQ(Sparkline(rising, 0, 7, false), "__.-=*##" + std::string()) << "six levels for eight values";
}

TEST(Sparkline, ClampsAndUsesTheMiddleForAnEmptyRange) {
  EXPECT_EQ(Sparkline(std::vector<double>{-9, 9}, 0, 1, true), "▁█");
  EXPECT_EQ(Sparkline(std::vector<double>{3, 3}, 3, 3, true), "▅▅");
  EXPECT_EQ(Sparkline({}, 0, 1, true), "");
}

TEST(Bar, IsAsFullAsTheValue) {
  EXPECT_EQ(Bar(0, 0, 1, 4, true), "    ");
  EXPECT_EQ(Bar(1, 0, 1, 4, true), "████");
  EXPECT_EQ(Bar(0.5, 0, 1, 3, true), "█▌ ");
  EXPECT_EQ(Bar(0.5, 0, 1, 4, false), "##..");
  for (double value = 0; value <= 1; value += 0.01) EXPECT_EQ(ColumnsOf(Bar(value, 0, 1, 7, true)), 7);
}

TEST(Wrapped, KeepsWordsAndWidth) {
  EXPECT_EQ(Wrapped("aa bb cc dd", 8, 2), "aa bb\n  cc dd");
  EXPECT_EQ(Wrapped("unbreakable x", 4, 0), "unbreakable\nx");
  EXPECT_EQ(Wrapped("", 10, 0), "");
}

TEST(Clipped, CountsCharactersNotBytes) {
  EXPECT_EQ(Clipped("▁▂▃", 2), "▁▂");
  EXPECT_EQ(Clipped("ab", 5), "ab");
  EXPECT_EQ(ColumnsOf("▁a"), 2);
}

TEST(DurationText, GrowsCoarser) {
  EXPECT_EQ(DurationText(0.2), "1 s");
  EXPECT_EQ(DurationText(119), "119 s");
  EXPECT_EQ(DurationText(180), "3 min");
  EXPECT_EQ(DurationText(7500), "2 h 05 min");
}

v1::Frame FrameAt(double time, double volume) {
  v1::Frame frame;
  frame.set_time(time);
  frame.set_tick(static_cast<std::int64_t>(1000 * time));
  frame.set_breath(volume);
  v1::MeasureReading& reading = *frame.add_measures();
  reading.set_name("lung volume");
  reading.set_unit("m^3");
  reading.set_value(1e-3 * volume);
  return frame;
}

TEST(LiveView, FitsEveryWidthAndShowsTheLastValue) {
  LiveView view;
  for (int i = 0; i <= 100; ++i) view.Add(FrameAt(0.1 * i, i % 10));
  for (const int width : {20, 40, 80, 200}) {
    const std::vector<std::string> lines = view.Lines({width, true});
    ASSERT_EQ(lines.size(), 3U) << "heading, breath, volume";
    for (const std::string& line : lines) EXPECT_LE(ColumnsOf(line), width);
  }
  const std::string volume = view.Lines({80, true})[2];
  EXPECT_THAT(volume, testing::HasSubstr("lung volume  0 l"));
  EXPECT_THAT(volume, testing::HasSubstr("▁▁▂▃▄▅▆▇██"));
}

TEST(LiveView, StartsAgainAfterAReset) {
  LiveView view;
  view.Add(FrameAt(1, 9));
  view.Add(FrameAt(0, 1));
  EXPECT_THAT(view.Lines({80, true})[2], testing::EndsWith("▅")) << "one value has no range";
}

}  // namespace
}  // namespace phrenic::client
