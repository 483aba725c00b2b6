#include "server/service/calls/reflection.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/support/slice.h>

#include <set>

namespace phrenic::service {
namespace {

using google::protobuf::DescriptorPool;
using google::protobuf::FileDescriptor;
using google::protobuf::UnknownField;
using google::protobuf::UnknownFieldSet;

// Field numbers of grpc/reflection/v1/reflection.proto.
constexpr int kFileByName = 3, kFileWithSymbol = 4, kListServices = 7;                       // of the request
constexpr int kOriginalRequest = 2, kFiles = 4, kServices = 6, kError = 7;                   // of the response
constexpr int kFile = 1, kService = 1, kServiceName = 1, kErrorCode = 1, kErrorMessage = 2;  // of their messages

constexpr access::Rule kRule = {"ServerReflection.ServerReflectionInfo"};

void AddFiles(const FileDescriptor& file, std::set<const FileDescriptor*>& seen, UnknownFieldSet& files) {
  if (!seen.insert(&file).second) return;
  google::protobuf::FileDescriptorProto copied;
  file.CopyTo(&copied);
  copied.SerializeToString(files.AddLengthDelimited(kFile));
  for (int i = 0; i < file.dependency_count(); ++i) AddFiles(*file.dependency(i), seen, files);
}

std::string BytesOf(const UnknownFieldSet& message) {
  std::string bytes;
  message.SerializeToString(&bytes);
  return bytes;
}

void AddError(grpc::StatusCode code, const std::string& text, UnknownFieldSet& response) {
  UnknownFieldSet error;
  error.AddVarint(kErrorCode, static_cast<std::uint64_t>(code));
  error.AddLengthDelimited(kErrorMessage, text);
  response.AddLengthDelimited(kError, BytesOf(error));
}

void AddServices(const std::vector<std::string>& names, UnknownFieldSet& response) {
  UnknownFieldSet services;
  for (const std::string& name : names) {
    UnknownFieldSet service;
    service.AddLengthDelimited(kServiceName, name);
    services.AddLengthDelimited(kService, BytesOf(service));
  }
  response.AddLengthDelimited(kServices, BytesOf(services));
}

// Adds the answer to one field of the request. False if the field asks nothing.
bool Answer(const UnknownField& asked, const std::vector<std::string>& services, UnknownFieldSet& response) {
  if (asked.type() != UnknownField::TYPE_LENGTH_DELIMITED || asked.number() < kFileByName) return false;
  if (asked.number() == kListServices) {
    AddServices(services, response);
    return true;
  }
  const DescriptorPool& pool = *DescriptorPool::generated_pool();
  const std::string& name = asked.length_delimited();
  const FileDescriptor* file = asked.number() == kFileByName       ? pool.FindFileByName(name)
                               : asked.number() == kFileWithSymbol ? pool.FindFileContainingSymbol(name)
                                                                   : nullptr;
  if (file == nullptr) {
    AddError(grpc::StatusCode::NOT_FOUND, "there is no such symbol or file", response);
    return true;
  }
  UnknownFieldSet files;
  std::set<const FileDescriptor*> seen;
  AddFiles(*file, seen, files);
  response.AddLengthDelimited(kFiles, BytesOf(files));
  return true;
}

std::optional<grpc::Status> Handle(ServedCall& call, const std::vector<std::string>& services) {
  std::vector<grpc::Slice> slices;
  call.request().Dump(&slices);
  std::string request;
  for (const grpc::Slice& slice : slices) request.append(slice.begin(), slice.end());
  const grpc::Slice response(Reflect(request, services));
  if (!call.Write(grpc::ByteBuffer(&response, 1))) return grpc::Status::CANCELLED;
  return std::nullopt;
}

}  // namespace

std::string Reflect(const std::string& request, const std::vector<std::string>& services) {
  UnknownFieldSet asked, response;
  bool answered = false;
  if (asked.ParseFromString(request)) {
    response.AddLengthDelimited(kOriginalRequest, request);
    for (int i = 0; i < asked.field_count() && !answered; ++i) answered = Answer(asked.field(i), services, response);
  }
  if (!answered) AddError(grpc::StatusCode::INVALID_ARGUMENT, "the request asks nothing", response);
  return BytesOf(response);
}

void AddReflection(CallTable& calls) {
  const std::vector<std::string> services = calls.Services();
  for (const char* package : {"grpc.reflection.v1alpha", "grpc.reflection.v1"}) {
    calls.Add(package, {.rule = &kRule,
                        .lane = Lane::kStream,
                        .handler = [services](ServedCall& call) { return Handle(call, services); },
                        .conversation = true});
  }
}

}  // namespace phrenic::service
