#include "server/fit/kept_fit.h"

#include <cstdint>
#include <cstring>

namespace phrenic::fit {
namespace {

constexpr std::string_view kMagic = "phrenic fit 1\n";

class FitWriter {
 public:
  template <typename T>
  void Plain(T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  // Returns how many elements follow.
  template <typename List>
  std::size_t Resize(List& list) {
    auto size = static_cast<std::uint64_t>(list.size());
    Plain(size);
    return list.size();
  }
  template <typename Matrix>
  void Numbers(Matrix& matrix) {
    auto rows = static_cast<std::int64_t>(matrix.rows()), cols = static_cast<std::int64_t>(matrix.cols());
    Plain(rows);
    Plain(cols);
    bytes_.append(reinterpret_cast<const char*>(matrix.data()),
                  sizeof(double) * static_cast<std::size_t>(matrix.size()));
  }
  void Text(std::string& text) {
    Resize(text);
    bytes_ += text;
  }
  std::string bytes_;
};

class FitReader {
 public:
  explicit FitReader(std::string_view bytes) : left_(bytes) {}

  template <typename T>
  void Plain(T& value) {
    if (sizeof value > left_.size()) {
      good_ = false;
      left_ = {};
      return;
    }
    std::memcpy(&value, left_.data(), sizeof value);
    left_.remove_prefix(sizeof value);
  }
  template <typename List>
  std::size_t Resize(List& list) {
    std::uint64_t size = 0;
    Plain(size);
    if (size > left_.size()) good_ = false;
    list.resize(good_ ? size : 0);
    return list.size();
  }
  template <typename Matrix>
  void Numbers(Matrix& matrix) {
    std::int64_t rows = 0, cols = 0;
    Plain(rows);
    Plain(cols);
    const auto most = static_cast<std::int64_t>(left_.size() / sizeof(double));
    constexpr int kRows = Matrix::RowsAtCompileTime, kCols = Matrix::ColsAtCompileTime;
    good_ = good_ && rows >= 0 && cols >= 0 && rows <= most && cols <= most && (rows == 0 || cols <= most / rows) &&
            (kRows < 0 || kRows == rows) && (kCols < 0 || kCols == cols);
    if (!good_) return;
    matrix.resize(rows, cols);
    const std::size_t size = sizeof(double) * static_cast<std::size_t>(matrix.size());
    if (size == 0) return;
    std::memcpy(matrix.data(), left_.data(), size);
    left_.remove_prefix(size);
  }
  void Text(std::string& text) {
    const std::size_t size = Resize(text);
    if (!good_) return;
    text.assign(left_.substr(0, size));
    left_.remove_prefix(size);
  }
  bool good() const { return good_ && left_.empty(); }

 private:
  std::string_view left_;
  bool good_ = true;
};

template <typename Archive>
void VisitLungs(Archive& archive, RegisteredLungs& registered) {
  archive.Plain(registered.gap);
  for (Registration& lung : registered.lungs) {
    archive.Numbers(lung.scale);
    archive.Numbers(lung.shift);
    archive.Plain(lung.outside);
    archive.Plain(lung.farthest);
  }
  archive.Plain(registered.points);
  archive.Resize(registered.doubts);
  for (std::string& doubt : registered.doubts) archive.Text(doubt);
}

template <typename Archive>
void VisitIndices(Archive& archive, std::vector<int>& indices) {
  archive.Resize(indices);
  for (int& index : indices) archive.Plain(index);
}

template <typename Archive>
void VisitErrors(Archive& archive, MotionFit& fit) {
  archive.Plain(fit.fitting);
  archive.Plain(fit.held_out);
  archive.Resize(fit.baselines);
  for (Baseline& each : fit.baselines) {
    archive.Text(each.name);
    archive.Plain(each.numbers);
    archive.Plain(each.held_out);
  }
  archive.Resize(fit.regions);
  for (RegionError& each : fit.regions) {
    archive.Text(each.name);
    archive.Plain(each.points);
    archive.Plain(each.motion);
    archive.Plain(each.error);
  }
}

// Writes or reads every part of a fit without an elastic deformation.
template <typename Archive>
void VisitFit(Archive& archive, MotionFit& fit) {
  VisitLungs(archive, fit.registered);
  VisitIndices(archive, fit.halves.fitting);
  VisitIndices(archive, fit.halves.held_out);
  archive.Plain(fit.descent);
  archive.Resize(fit.parameters);
  for (FittedNumber& each : fit.parameters) {
    archive.Text(each.name);
    archive.Text(each.what);
    archive.Plain(each.value);
    archive.Plain(each.standard_error);
    archive.Plain(each.spread);
    auto determined = static_cast<std::uint8_t>(each.determined);
    archive.Plain(determined);
    each.determined = determined == 1;
  }
  archive.Numbers(fit.correlation);
  VisitErrors(archive, fit);
  archive.Plain(fit.volume);
  for (Points* points : {&fit.exhale, &fit.motion, &fit.predicted}) archive.Numbers(*points);
  archive.Numbers(fit.person.responses);
  archive.Numbers(fit.person.motion);
  archive.Numbers(fit.person.amplitudes);
  archive.Plain(fit.person.descent);
  archive.Numbers(fit.held_out_responses);
}

// True if the parts fit together.
bool IsWhole(const MotionFit& fit) {
  const auto in_range = [&](const std::vector<int>& indices) {
    for (const int i : indices) {
      if (i < 0 || i >= fit.exhale.cols()) return false;
    }
    return true;
  };
  const auto numbers = static_cast<Eigen::Index>(fit.parameters.size());
  const auto held_out = static_cast<Eigen::Index>(fit.halves.held_out.size());
  return in_range(fit.halves.fitting) && in_range(fit.halves.held_out) && fit.motion.cols() == fit.exhale.cols() &&
         fit.predicted.cols() == fit.exhale.cols() && fit.correlation.rows() == numbers &&
         fit.correlation.cols() == numbers && fit.person.amplitudes.size() == numbers &&
         fit.person.responses.cols() == numbers && fit.person.responses.rows() == fit.person.motion.size() &&
         fit.held_out_responses.cols() == numbers && fit.held_out_responses.rows() == 3 * held_out;
}

}  // namespace

std::string KeepFit(const MotionFit& fit) {
  MotionFit copy = fit;
  FitWriter writer;
  writer.bytes_ = kMagic;
  VisitFit(writer, copy);
  return std::move(writer.bytes_);
}

std::optional<MotionFit> ReadKeptFit(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) return std::nullopt;
  FitReader reader(bytes.substr(kMagic.size()));
  MotionFit fit;
  VisitFit(reader, fit);
  if (!reader.good() || !IsWhole(fit)) return std::nullopt;
  return fit;
}

}  // namespace phrenic::fit
