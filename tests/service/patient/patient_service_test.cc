// PatientService over a socket: from an uploaded label volume to a session.
#include <fstream>
#include <sstream>

#include "phrenic/v1/patients.grpc.pb.h"
#include "phrenic/v1/upload.grpc.pb.h"
#include "server/imaging/gzip.h"
#include "server/imaging/labels/label_map.h"
#include "server/imaging/nifti.h"
#include "server/imaging/phantom.h"
#include "tests/service/guarded_server.h"

namespace phrenic::service {
namespace {

using testing::HasSubstr;
using testing::Not;

// A phantom with voxels of 5 mm, and its labels by name.
const imaging::LabelVolume& Phantom() {
  static const imaging::LabelVolume phantom = [] {
    const auto map = imaging::ReadLabelMap("totalsegmentator");
    imaging::LabelVolume volume = *imaging::MakePhantom(*imaging::FindPhantomBody("adult"), {.voxel = 5}, *map);
    for (const v1::LabelMeaning& label : map->labels()) volume.names.emplace(label.number(), label.name());
    return volume;
  }();
  return phantom;
}

// Cuts a slab of the phantom's lower slices.
imaging::LabelVolume Slab(int slices) {
  imaging::LabelVolume slab = Phantom();
  slab.size.z() = slices;
  slab.labels.resize(static_cast<std::size_t>(slab.size.prod()));
  return slab;
}

std::string Packed(const imaging::LabelVolume& volume) { return imaging::Deflate(imaging::WriteNifti(volume)); }

class PatientServiceTest : public GuardedServer {
 protected:
  using Patients = v1::PatientService::Stub;

  void SetUp() override {
    GuardedServer::SetUp();
    patients_ = v1::PatientService::NewStub(channel_);
    uploads_ = v1::UploadService::NewStub(channel_);
  }
  // Uploads a file in one chunk and returns the status; `path` gets its name.
  grpc::Status Upload(const std::string& bytes, std::string* path = nullptr) {
    grpc::ClientContext begins, adds, finishes;
    for (grpc::ClientContext* context : {&begins, &adds, &finishes}) Sign({"owner"}, *context);
    v1::BeginUploadRequest begin;
    begin.set_name("Doe^Jane 1948.nii.gz");
    begin.set_size(static_cast<std::int64_t>(bytes.size()));
    begin.set_kind(v1::UPLOAD_KIND_LABELS);
    v1::BeginUploadResponse begun;
    if (const auto status = uploads_->BeginUpload(&begins, begin, &begun); !status.ok()) return status;
    v1::AddUploadChunkRequest add;
    add.set_upload_id(begun.upload_id());
    add.set_chunk(bytes);
    v1::AddUploadChunkResponse added;
    if (const auto status = uploads_->AddUploadChunk(&adds, add, &added); !status.ok()) return status;
    v1::FinishUploadRequest finish;
    finish.set_upload_id(begun.upload_id());
    v1::FinishUploadResponse finished;
    const grpc::Status status = uploads_->FinishUpload(&finishes, finish, &finished);
    EXPECT_THAT(finished.DebugString(), Not(HasSubstr("Doe")));
    if (path != nullptr) *path = finished.file().path();
    return status;
  }
  std::string Uploaded(const imaging::LabelVolume& volume) {
    std::string path;
    const grpc::Status status = Upload(Packed(volume), &path);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return path;
  }
  v1::InspectLabelsResponse Inspect(const std::string& path) {
    v1::InspectLabelsResponse table;
    const auto status = CallAs({"owner"}, *patients_, &Patients::InspectLabels, "path: '" + path + "'", &table);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return table;
  }
  // Makes a patient with few vertices and returns its last message. Ribs need edges of at most 6 mm to breathe.
  v1::Patient Make(const std::string& path, const std::string& more, int edge = 12) {
    v1::CreatePatientResponse created;
    const std::string request = absl::StrCat("path: '", path, "' vertices: 800 edge_length_mm: ", edge, " ", more);
    const auto status = CallAs({"owner"}, *patients_, &Patients::CreatePatient, request, &created);
    EXPECT_TRUE(status.ok()) << status.error_message();
    grpc::ClientContext context;
    Sign({"owner"}, context);
    v1::WatchPatientRequest watch;
    watch.set_patient_id(created.patient().id());
    const auto reader = patients_->WatchPatient(&context, watch);
    v1::WatchPatientResponse response;
    double progress = 0;
    while (reader->Read(&response)) {
      EXPECT_GE(response.patient().progress(), progress);
      progress = response.patient().progress();
    }
    EXPECT_TRUE(reader->Finish().ok());
    return response.patient();
  }
  std::string Audit() const {
    std::ifstream file(options_.audit_file);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  std::unique_ptr<Patients> patients_;
  std::unique_ptr<v1::UploadService::Stub> uploads_;
};

TEST_F(PatientServiceTest, APhantomIsInspectedMadeAndSteps) {
  const std::string path = Uploaded(Phantom());
  const v1::InspectLabelsResponse table = Inspect(path);
  EXPECT_EQ(table.format(), "NIfTI");
  EXPECT_EQ(table.voxels().k(), Phantom().size.z());
  EXPECT_NEAR(table.spacing_mm().x(), 5, 1e-6);
  ASSERT_GT(table.labels_size(), 30);
  double lungs = 0;
  for (const v1::FoundLabel& label : table.labels()) {
    EXPECT_TRUE(label.has_proposed()) << label.name();
    EXPECT_EQ(label.proposed().number(), label.number());
    if (label.proposed().anatomy().structure() == v1::STRUCTURE_LUNG) lungs += label.volume_ml();
  }
  EXPECT_GT(lungs, 2000);
  EXPECT_LT(lungs, 8000);
  for (const v1::MissingStructure& missing : table.missing()) EXPECT_FALSE(missing.needed());

  const v1::Patient patient = Make(path, "anyway: true", 5);
  ASSERT_EQ(patient.state(), v1::PATIENT_STATE_DONE) << patient.problem();
  EXPECT_NE(patient.report().readiness().verdict(), v1::READINESS_VERDICT_UNSPECIFIED);
  ASSERT_TRUE(patient.has_scene());
  v1::CreateSessionResponse created;
  std::string scene;
  google::protobuf::TextFormat::PrintToString(patient.scene(), &scene);
  const auto status =
      CallAs({"owner"}, *sessions_, &Sessions::CreateSession, "source { scene { " + scene + " } }", &created);
  ASSERT_TRUE(status.ok()) << status.error_message();
  v1::StepSessionResponse stepped;
  const std::string step = "session_id: '" + created.session().id() + "' ticks: 3";
  EXPECT_TRUE(CallAs({"owner"}, *sessions_, &Sessions::StepSession, step, &stepped).ok());
  EXPECT_THAT(Audit() + created.session().id() + patient.id() + scene, Not(HasSubstr("Doe")));
  EXPECT_THAT(Audit(), HasSubstr("CreatePatient"));
}

TEST_F(PatientServiceTest, NamedLabelsAreThoseOfUnknownNames) {
  const v1::Patient known = Make(Uploaded(Phantom()), "anyway: true");
  imaging::LabelVolume unnamed = Phantom();
  for (auto& [number, name] : unnamed.names) name = absl::StrCat("Segment ", number);
  const std::string path = Uploaded(unnamed);
  const v1::InspectLabelsResponse table = Inspect(path);
  std::string labels;
  for (const v1::FoundLabel& label : table.labels()) {
    EXPECT_FALSE(label.has_proposed()) << label.name();
    for (const v1::LabelMeaning& choice : table.choices()) {
      if (choice.number() == label.number()) absl::StrAppend(&labels, "labels { ", choice.ShortDebugString(), " } ");
    }
  }
  EXPECT_TRUE(table.missing(0).needed());
  const v1::Patient nameless = Make(path, "");
  EXPECT_EQ(nameless.state(), v1::PATIENT_STATE_FAILED);
  EXPECT_FALSE(nameless.has_scene());
  const v1::Patient named = Make(path, labels + "anyway: true");
  ASSERT_EQ(named.state(), v1::PATIENT_STATE_DONE) << named.problem();
  EXPECT_EQ(named.report().diaphragm().area_cm2(), known.report().diaphragm().area_cm2());
  EXPECT_EQ(named.report().surfaces_size(), known.report().surfaces_size());
}

TEST_F(PatientServiceTest, ASlabIsRefusedWithReasonsUnlessItIsWantedAnyway) {
  const std::string path = Uploaded(Slab(Phantom().size.z() / 2));
  const v1::Patient refused = Make(path, "");
  ASSERT_EQ(refused.state(), v1::PATIENT_STATE_FAILED);
  EXPECT_FALSE(refused.has_scene());
  EXPECT_EQ(refused.report().readiness().verdict(), v1::READINESS_VERDICT_NOT_USABLE);
  ASSERT_GT(refused.report().readiness().findings_size(), 0);
  EXPECT_THAT(refused.problem(), HasSubstr(refused.report().readiness().findings(0).what()));
  EXPECT_TRUE(Make(path, "anyway: true").has_scene());
}

// Numbers without names are read by the program's map that fits, or by the one that is asked for.
TEST_F(PatientServiceTest, NumbersAreReadByTheProgramThatFits) {
  const auto map = imaging::ReadLabelMap("vista3d");
  imaging::LabelVolume volume = *imaging::MakePhantom(*imaging::FindPhantomBody("adult"), {.voxel = 5}, *map);
  volume.names.clear();
  const std::string path = Uploaded(volume);
  const v1::InspectLabelsResponse table = Inspect(path);
  EXPECT_EQ(table.map(), "vista3d");
  ASSERT_GT(table.tools_size(), 2);
  EXPECT_EQ(table.tools(0).title(), "VISTA3D");
  EXPECT_GT(table.tools(0).agree() - table.tools(0).differ(), table.tools(1).agree() - table.tools(1).differ());
  for (const v1::FoundLabel& label : table.labels()) EXPECT_TRUE(label.has_proposed()) << label.number();
  v1::InspectLabelsResponse other;
  const std::string by = "path: '" + path + "' map: ";
  ASSERT_TRUE(CallAs({"owner"}, *patients_, &Patients::InspectLabels, by + "'totalsegmentator'", &other).ok());
  EXPECT_EQ(other.map(), "totalsegmentator");
  const auto unknown = CallAs({"owner"}, *patients_, &Patients::InspectLabels, by + "'../vista3d'", &other);
  EXPECT_EQ(unknown.error_code(), grpc::INVALID_ARGUMENT);
  EXPECT_THAT(unknown.error_message(), HasSubstr("totalsegmentator, vista3d"));
  EXPECT_EQ(Make(path, "anyway: true").state(), v1::PATIENT_STATE_DONE);
}

TEST_F(PatientServiceTest, PatientsAreListedForTheirOwnerWithoutTheirScenes) {
  const v1::Patient made = Make(Uploaded(Phantom()), "anyway: true");
  v1::ListPatientsResponse own, others;
  ASSERT_TRUE(CallAs({"owner"}, *patients_, &Patients::ListPatients, "", &own).ok());
  ASSERT_TRUE(CallAs({"other"}, *patients_, &Patients::ListPatients, "", &others).ok());
  ASSERT_EQ(own.patients_size(), 1);
  EXPECT_EQ(own.patients(0).id(), made.id());
  EXPECT_EQ(own.patients(0).state(), v1::PATIENT_STATE_DONE);
  EXPECT_FALSE(own.patients(0).has_scene() || own.patients(0).has_report());
  EXPECT_EQ(others.patients_size(), 0);
}

TEST_F(PatientServiceTest, OthersSeeNeitherVolumeNorPatient) {
  const std::string path = Uploaded(Slab(4));
  v1::InspectLabelsResponse table;
  const std::string named = "path: '" + path + "'";
  EXPECT_EQ(CallAs({"other"}, *patients_, &Patients::InspectLabels, named, &table).error_code(), grpc::NOT_FOUND);
  EXPECT_EQ(CallAs({"viewer"}, *patients_, &Patients::InspectLabels, named, &table).error_code(),
            grpc::PERMISSION_DENIED);
  v1::CreatePatientResponse created;
  ASSERT_TRUE(CallAs({"owner"}, *patients_, &Patients::CreatePatient, named, &created).ok());
  v1::DeletePatientResponse deleted;
  const std::string patient = "patient_id: '" + created.patient().id() + "'";
  EXPECT_EQ(CallAs({"other"}, *patients_, &Patients::DeletePatient, patient, &deleted).error_code(), grpc::NOT_FOUND);
  EXPECT_TRUE(CallAs({"owner"}, *patients_, &Patients::DeletePatient, patient, &deleted).ok());
  EXPECT_EQ(CallAs({"owner"}, *patients_, &Patients::DeletePatient, patient, &deleted).error_code(), grpc::NOT_FOUND);
}

TEST_F(PatientServiceTest, WhatIsNoLabelVolumeIsRefused) {
  EXPECT_EQ(Upload(std::string(2000, 'x')).error_code(), grpc::INVALID_ARGUMENT);
  std::string slice(2000, '\0');
  slice.replace(128, 4, "DICM");
  std::string path;
  ASSERT_TRUE(Upload(slice, &path).ok());
  v1::InspectLabelsResponse table;
  const auto damaged = CallAs({"owner"}, *patients_, &Patients::InspectLabels, "path: '" + path + "'", &table);
  EXPECT_EQ(damaged.error_code(), grpc::INVALID_ARGUMENT);
  // A header that declares 1,024 x 1,024 x 1,024 voxels of zeros, which a small file could hold.
  imaging::LabelVolume large = Slab(1);
  std::string bytes = imaging::WriteNifti(large);
  for (const int axis : {1, 2, 3}) bytes.replace(40 + 2 * static_cast<std::size_t>(axis), 2, std::string("\0\4", 2));
  bytes.append(std::size_t{64} << 20, '\0');
  ASSERT_TRUE(Upload(imaging::Deflate(bytes), &path).ok());
  const auto too_large = CallAs({"owner"}, *patients_, &Patients::InspectLabels, "path: '" + path + "'", &table);
  EXPECT_EQ(too_large.error_code(), grpc::RESOURCE_EXHAUSTED);
  EXPECT_THAT(too_large.error_message(), HasSubstr("crop it to the thorax"));
}

TEST_F(PatientServiceTest, WrongNamesAreNamed) {
  const std::string path = "path: '" + Uploaded(Slab(4)) + "' ";
  const auto problem = [&](const std::string& labels) {
    const std::string name = path.substr(7, path.size() - 9);
    return Make(name, labels).problem();
  };
  EXPECT_THAT(problem("labels { number: 1 name: 'a' }"), HasSubstr("labels[0]: say which organ"));
  EXPECT_THAT(
      problem("labels { number: 1 name: 'a' organ: ORGAN_LIVER } labels { number: 1 name: 'b' organ: ORGAN_HEART }"),
      HasSubstr("labels[1]: label 1 is named twice"));
  EXPECT_THAT(problem("labels { number: 1 name: '<b>' organ: ORGAN_LIVER }"), HasSubstr("letters, digits"));
}

}  // namespace
}  // namespace phrenic::service
