// The commands of `phrenic`. Scripts rely on their names, options, JSON keys and exit codes (connection/context.h).
//
// Each SetUp function adds the arguments of one command to `command` and returns the function that runs it, with the
// values parsed by then. That function prints results on standard output and everything else on standard error
// (connection/errors.h), and returns the exit code: kOk, or, where nothing else is said below, what Fail returns. It
// blocks until the work is done, is called once, and ends with kInterrupted after Ctrl-C. All of this runs on the main
// thread; connection/connection.h has the deadline of calls.
#ifndef PHRENIC_CLIENT_COMMANDS_COMMANDS_H_
#define PHRENIC_CLIENT_COMMANDS_COMMANDS_H_

#include "client/cli/command.h"

namespace phrenic::client {

// Returns the table of all commands, in the order of the help. Static storage; thread-safe.
CommandTable Commands();

// --- scenes, without a server ---
// run.cc, replay.cc: call the server's services in this process over an in-process channel. kMissed if a residual is
// above that of `run --check`, or if the final state of a replay differs from the recorded one in any bit; kFailed if
// the session diverged.
CommandFunction SetUpRun(CLI::App& command);
CommandFunction SetUpReplay(CLI::App& command);
// physiology.cc: CheckPhysiology, in this process or on a server. With --check, kMissed if a value is out of its range.
CommandFunction SetUpPhysiology(CLI::App& command);
// lungs.cc: physiology/lung_breath.h on a scene compiled in this process; no service.
CommandFunction SetUpLungs(CLI::App& command);
// calibrate.cc: calibrate/ on a scene compiled in this process; no service. kMissed if the measures are not reached.
CommandFunction SetUpCalibrate(CLI::App& command);
// fit.cc: fit/ on the lungs of a scene and files of landmarks; no service. Files are written whole or not at all.
CommandFunction SetUpRegister(CLI::App& command);
CommandFunction SetUpFit(CLI::App& command);
// patient.cc, phantom.cc: imaging/ on files, and phantom/ on a run in this process; no service, except with
// `patient --serve`. Files are written whole or not
// at all.
CommandFunction SetUpPatient(CLI::App& command);
CommandFunction SetUpPhantom(CLI::App& command);
// fluoroscopy/fluoroscopy.cc: fluoroscopy/ on a run in this process; no service.
CommandFunction SetUpFluoroscopy(CLI::App& command);

// --- sessions of a server ---
// scenes.cc, describe.cc: ListScenes, DescribeScene. Compiling a large scene takes minutes; the server's limits apply
// to scene files.
CommandFunction SetUpScenes(CLI::App& command);
CommandFunction SetUpDescribe(CLI::App& command);
// create.cc: CreateSession, ForkSession and, with --play, PlaySession. The session's owner token is kept for later
// commands (files/tokens.h).
CommandFunction SetUpCreate(CLI::App& command);
CommandFunction SetUpFork(CLI::App& command);
// sessions.cc, watch.cc: ListSessions, WatchFrames. `watch` ends with the session, --count or --seconds, and reconnects
// for up to a minute after the server stops.
CommandFunction SetUpSessions(CLI::App& command);
CommandFunction SetUpWatch(CLI::App& command);
// change_session.cc: the call of SessionService with the command's name, and UpdateParameters. Prints the session
// afterwards; kFailed if it has diverged.
CommandFunction SetUpSet(CLI::App& command);
CommandFunction SetUpPull(CLI::App& command);
CommandFunction SetUpPlay(CLI::App& command);
CommandFunction SetUpStep(CLI::App& command);
CommandFunction SetUpPause(CLI::App& command);
CommandFunction SetUpReset(CLI::App& command);
CommandFunction SetUpDelete(CLI::App& command);
// control.cc: ControlService. `take` keeps the token of control in the user's files (files/tokens.h); the others send
// it and fail if no token is kept.
CommandFunction SetUpControlShow(CLI::App& command);
CommandFunction SetUpControlTake(CLI::App& command);
CommandFunction SetUpControlHand(CLI::App& command);
CommandFunction SetUpControlLend(CLI::App& command);
CommandFunction SetUpControlRelease(CLI::App& command);
// link.cc: AccessService, on servers with accounts. Only `create` shows the link's secret, once.
CommandFunction SetUpLinkCreate(CLI::App& command);
CommandFunction SetUpLinkList(CLI::App& command);
CommandFunction SetUpLinkRevoke(CLI::App& command);
// export.cc, exports.cc: ExportService. A download goes to a part file that is renamed once its SHA-256 is right.
CommandFunction SetUpExport(CLI::App& command);
CommandFunction SetUpExportsList(CLI::App& command);
CommandFunction SetUpExportsGet(CLI::App& command);
CommandFunction SetUpExportsDelete(CLI::App& command);
// upload.cc: BeginUpload, AddUploadChunk, FinishUpload. Prints the path by which a scene names the file.
CommandFunction SetUpUpload(CLI::App& command);

// --- studies ---
// study.cc: CreateStudy and WatchStudy, in this process or on a server, where a study goes on if the command is
// interrupted. kMissed if a limit of --limits is exceeded. ListStudies, DeleteStudy.
CommandFunction SetUpStudyError(CLI::App& command);
CommandFunction SetUpStudyStability(CLI::App& command);
CommandFunction SetUpStudyCost(CLI::App& command);
CommandFunction SetUpStudyStreaming(CLI::App& command);
CommandFunction SetUpStudySensitivity(CLI::App& command);
CommandFunction SetUpStudyUncertainty(CLI::App& command);
CommandFunction SetUpStudyConvergence(CLI::App& command);
// study_motion.cc: fit/ on many people's landmarks, in this process; no service.
CommandFunction SetUpStudyMotion(CLI::App& command);
CommandFunction SetUpStudyList(CLI::App& command);
CommandFunction SetUpStudyWatch(CLI::App& command);
CommandFunction SetUpStudyDelete(CLI::App& command);
// credibility.cc: the studies that a context requires, in this process, and a report of them (credibility/). With
// --check, kMissed if a required section is not met.
CommandFunction SetUpCredibility(CLI::App& command);
// campaign.cc: many runs, on this machine's cores or as jobs of Slurm, which call `work` (campaign/). Repeated, `run`
// continues where it was interrupted. kMissed if a limit is exceeded, kFailed if runs failed.
CommandFunction SetUpCampaignRun(CLI::App& command);
CommandFunction SetUpCampaignReport(CLI::App& command);
CommandFunction SetUpCampaignWork(CLI::App& command);

// --- files and this program ---
// compare.cc: Compare, in this process or on a server. kMissed if a limit is exceeded.
CommandFunction SetUpCompare(CLI::App& command);
// inspect.cc, convert.cc: compare/ and meshio/ on files; no service.
CommandFunction SetUpInspect(CLI::App& command);
CommandFunction SetUpConvert(CLI::App& command);
// doctor.cc: GetServer, and the folders and programs of this machine. Prints a remedy for each problem. kUnreachable if
// there is no server.
CommandFunction SetUpDoctor(CLI::App& command);
// completion.cc, man.cc: text made from the table of commands.
CommandFunction SetUpCompletion(CLI::App& command);
CommandFunction SetUpMan(CLI::App& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_COMMANDS_COMMANDS_H_
