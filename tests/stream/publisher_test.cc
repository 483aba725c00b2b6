#include "server/stream/publisher.h"

#include <atomic>

#include "tests/compile_text.h"
#include "tests/fake_clock.h"
#include "tests/small_scenes.h"

namespace phrenic::stream {
namespace {

v1::WatchFramesResponse Parse(const Bytes& bytes) {
  v1::WatchFramesResponse response;
  EXPECT_TRUE(response.ParseFromString(*bytes));
  return response;
}

class PublisherTest : public testing::Test {
 protected:
  void Offer(std::int64_t sequence) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->sequence = sequence;
    snapshot->state = model_->InitialState();
    snapshot->parameters = model_->parameters;
    snapshot->made = clock_.Now();
    publisher_.Offer(std::move(snapshot));
  }

  std::shared_ptr<Viewer> Join(const ViewerOptions& options = {}) {
    auto viewer = publisher_.Join(options, [] {});
    EXPECT_TRUE(viewer.ok()) << viewer.status();
    return *viewer;
  }

  // The next frame in the mailbox, past what is said of the session.
  Bytes NextFrame(Viewer& viewer) {
    Bytes frame;
    const bool came = Eventually([&] {
      const Bytes bytes = viewer.Take(absl::Now());
      if (bytes != nullptr && Parse(bytes).has_frame()) frame = bytes;
      return frame != nullptr;
    });
    EXPECT_TRUE(came) << "no frame came";
    return frame;
  }

  absl::StatusOr<v1::AckFramesResponse> Acknowledge(const std::string& watch_id, std::int64_t sequence) {
    v1::AckFramesRequest request;
    request.set_watch_id(watch_id);
    request.set_sequence(sequence);
    return publisher_.Acknowledge(request);
  }

  std::shared_ptr<const Model> model_ = CompileText(kTriangle);
  FakeClock clock_;
  Publisher publisher_{model_, clock_, 4};
};

TEST(Viewer, NewestFrameReplacesTheOlder) {
  int woken = 0;
  Viewer viewer({}, [&] { ++woken; });
  const auto first = std::make_shared<const std::string>("first"),
             second = std::make_shared<const std::string>("second");
  viewer.PutFrame(1, first, absl::Now());
  viewer.PutFrame(2, second, absl::Now());
  EXPECT_EQ(viewer.Take(absl::Now()), second);
  EXPECT_EQ(viewer.Take(absl::Now()), nullptr);
  EXPECT_EQ(viewer.missed(), 1);
  EXPECT_EQ(woken, 2);
}

TEST(Viewer, StateOfTheSessionComesBeforeAFrame) {
  Viewer viewer({}, [] {});
  const auto frame = std::make_shared<const std::string>("frame"), session = std::make_shared<const std::string>("s");
  viewer.PutFrame(1, frame, absl::Now());
  viewer.PutSession({.revision = 1, .bytes = session});
  viewer.End(absl::NotFoundError("deleted"));
  EXPECT_FALSE(viewer.ended().has_value()) << "what was put before the end is lost";
  EXPECT_EQ(viewer.Take(absl::Now()), session);
  EXPECT_EQ(viewer.Take(absl::Now()), frame);
  ASSERT_TRUE(viewer.ended().has_value());
  EXPECT_TRUE(absl::IsNotFound(*viewer.ended()));
}

TEST_F(PublisherTest, AFrameIsEncodedOnceHoweverManyWatch) {
  const auto a = Join(), b = Join(), c = Join();
  for (int sequence = 1; sequence <= 5; ++sequence) {
    Offer(sequence);
    const Bytes frame = NextFrame(*a);
    EXPECT_EQ(NextFrame(*b), frame) << "the bytes are not shared";
    EXPECT_EQ(NextFrame(*c), frame);
    EXPECT_EQ(Parse(frame).frame().sequence(), sequence);
  }
  EXPECT_EQ(publisher_.encodings(), 5);
}

TEST_F(PublisherTest, NothingIsEncodedForNobody) {
  for (int sequence = 1; sequence <= 3; ++sequence) Offer(sequence);
  const auto late = Join();
  EXPECT_EQ(Parse(NextFrame(*late)).frame().sequence(), 3) << "a late viewer has to wait for the next frame";
  EXPECT_EQ(publisher_.encodings(), 1);
}

TEST_F(PublisherTest, ASlowViewerMissesFramesAndGetsTheNewest) {
  const auto slow = Join(), quick = Join();
  for (int sequence = 1; sequence <= 10; ++sequence) {
    Offer(sequence);
    NextFrame(*quick);
  }
  // The slow one's mailbox is filled just before the quick one's.
  EXPECT_EQ(Parse(NextFrame(*slow)).frame().sequence(), 10);
  EXPECT_EQ(slow->missed(), 9);
  EXPECT_EQ(quick->missed(), 0);
}

TEST_F(PublisherTest, MaxFpsHoldsFramesBackUntilTheyAreDue) {
  const auto viewer = Join({.max_fps = 10});
  Offer(1);
  NextFrame(*viewer);
  const auto unlimited = Join();
  Offer(2);
  Offer(3);
  while (Parse(NextFrame(*unlimited)).frame().sequence() < 3) continue;
  for (Bytes bytes = viewer->Take(absl::Now()); bytes != nullptr; bytes = viewer->Take(absl::Now())) {
    EXPECT_FALSE(Parse(bytes).has_frame()) << "a frame came before its time";
  }
  clock_.Advance(absl::Milliseconds(101));
  EXPECT_EQ(Parse(NextFrame(*viewer)).frame().sequence(), 3);
}

TEST(Viewer, ChangesOfTheSessionAllComeAndProgressReplacesItself) {
  Viewer viewer({}, [] {});
  const auto text = [](const char* words) { return std::make_shared<const std::string>(words); };
  const Bytes played = text("played"), progress = text("progress"), paused = text("paused");
  viewer.PutSession({.revision = 1, .bytes = played});
  viewer.PutSession({.revision = 1, .bytes = progress});
  viewer.PutSession({.revision = 2, .bytes = paused});
  EXPECT_EQ(viewer.Take(absl::Now()), progress);
  EXPECT_EQ(viewer.Take(absl::Now()), paused);
  EXPECT_EQ(viewer.Take(absl::Now()), nullptr);
  for (std::size_t i = 0; i <= kMaxUpdates; ++i) {
    EXPECT_FALSE(viewer.ended().has_value());
    viewer.PutSession({.revision = static_cast<std::int64_t>(3 + i), .bytes = paused});
  }
  ASSERT_TRUE(viewer.ended().has_value()) << "a viewer that takes nothing is kept for ever";
  EXPECT_TRUE(absl::IsResourceExhausted(*viewer.ended()));
}

TEST(Viewer, TakesNoMoreFramesThanItsWindowUntilItAcknowledges) {
  int woken = 0;
  Viewer viewer({.max_unacked = 2}, [&] { ++woken; });
  const auto frame = std::make_shared<const std::string>("frame");
  for (int sequence = 1; sequence <= 3; ++sequence) {
    viewer.PutFrame(sequence, frame, absl::Now());
    EXPECT_EQ(viewer.Take(absl::Now()), sequence < 3 ? frame : nullptr);
  }
  const v1::AckFramesResponse given = viewer.Acknowledge(2, 0, absl::Now());
  EXPECT_EQ(woken, 4) << "who serves it does not hear that it may go on";
  EXPECT_EQ(given.max_unacked_frames(), 2);
  EXPECT_EQ(given.frames_per_second(), 2);
  EXPECT_EQ(viewer.Take(absl::Now()), frame);
}

TEST_F(PublisherTest, EachFormIsEncodedOnceAndHoldsWhatWasAskedFor) {
  const FrameEncoding predicted{.codec = v1::CODEC_PREDICTED}, nothing{.chosen = true};
  const auto raw = Join(), a = Join({.encoding = predicted}), b = Join({.encoding = predicted}),
             none = Join({.encoding = nothing});
  Offer(1);
  const Bytes frame = NextFrame(*a);
  EXPECT_EQ(NextFrame(*b), frame);
  EXPECT_EQ(Parse(frame).frame().codec(), v1::CODEC_PREDICTED);
  EXPECT_DOUBLE_EQ(Parse(frame).frame().max_error_mm(), 0.1);
  EXPECT_EQ(Parse(NextFrame(*raw)).frame().positions().size(), 36U);
  EXPECT_TRUE(Parse(NextFrame(*none)).frame().positions().empty());
  EXPECT_EQ(publisher_.encodings(), 3);
}

TEST_F(PublisherTest, NothingIsEncodedForThoseWhoMayNotTakeItAndTheNewestComesOnceTheyMay) {
  const auto full = Join({.encoding = {.codec = v1::CODEC_PREDICTED}, .max_unacked = 1, .watch_id = "full"}),
             raw = Join();
  for (int sequence = 1; sequence <= 5; ++sequence) {
    Offer(sequence);
    NextFrame(*raw);
    if (sequence == 1) NextFrame(*full);
  }
  EXPECT_EQ(publisher_.encodings(), 5 + 1) << "frames were encoded for a viewer that could not take them";
  EXPECT_EQ(full->missed(), 3) << "of 2 to 5 the last still waits";
  ASSERT_TRUE(Acknowledge("full", 1).ok());
  EXPECT_EQ(Parse(NextFrame(*full)).frame().sequence(), 5);
  EXPECT_EQ(publisher_.encodings(), 5 + 2);
}

TEST_F(PublisherTest, WhatOneMayTakeIsThereForAllOfItsForm) {
  const FrameEncoding encoding{.codec = v1::CODEC_PREDICTED};
  const auto full = Join({.encoding = encoding, .max_unacked = 1, .watch_id = "full"}),
             quick = Join({.encoding = encoding});
  for (int sequence = 1; sequence <= 3; ++sequence) {
    Offer(sequence);
    NextFrame(*quick);
    if (sequence == 1) NextFrame(*full);
  }
  EXPECT_EQ(full->missed(), 1);
  EXPECT_EQ(full->Acknowledge(1, 0, absl::Now()).max_unacked_frames(), 1);
  EXPECT_EQ(Parse(NextFrame(*full)).frame().sequence(), 3);
  EXPECT_EQ(publisher_.encodings(), 3);
}

TEST_F(PublisherTest, ANameIsOneViewersAlone) {
  const auto viewer = Join({.watch_id = "page"});
  EXPECT_TRUE(Acknowledge("page", 0).ok());
  EXPECT_TRUE(absl::IsAlreadyExists(publisher_.Join({.watch_id = "page"}, [] {}).status()));
  EXPECT_TRUE(absl::IsNotFound(Acknowledge("other", 0).status()));
  publisher_.Leave(viewer);
  EXPECT_TRUE(absl::IsNotFound(Acknowledge("page", 0).status()));
  Join({.watch_id = "page"});
}

TEST_F(PublisherTest, StateOfTheSessionIsTheFirstThingAViewerGets) {
  v1::Session session;
  session.set_revision(7);
  publisher_.Announce(session);
  Offer(1);
  const auto viewer = Join();
  Bytes first;
  ASSERT_TRUE(Eventually([&] { return (first = viewer->Take(absl::Now())) != nullptr; }));
  EXPECT_EQ(Parse(first).session().revision(), 7);
  EXPECT_EQ(Parse(first).session().viewers(), 1);
}

TEST_F(PublisherTest, MoreViewersThanAllowedAreRefused) {
  std::vector<std::shared_ptr<Viewer>> viewers;
  for (int i = 0; i < 4; ++i) viewers.push_back(Join());
  EXPECT_TRUE(absl::IsResourceExhausted(publisher_.Join({}, [] {}).status()));
  publisher_.Leave(viewers[0]);
  EXPECT_EQ(publisher_.viewers(), 3);
  Join();
}

TEST_F(PublisherTest, CloseEndsEveryViewerWithItsReason) {
  const auto viewer = Join();
  publisher_.Close(absl::NotFoundError("session x was deleted"));
  while (viewer->Take(absl::Now()) != nullptr) continue;
  ASSERT_TRUE(viewer->ended().has_value());
  EXPECT_EQ(viewer->ended()->message(), "session x was deleted");
  EXPECT_TRUE(absl::IsNotFound(publisher_.Join({}, [] {}).status()));
}

}  // namespace
}  // namespace phrenic::stream
