// The commands of `phrenic`. Scripts rely on their names, options, JSON keys and exit codes.
#ifndef PHRENIC_CLIENT_COMMANDS_COMMANDS_H_
#define PHRENIC_CLIENT_COMMANDS_COMMANDS_H_

#include "client/cli/command.h"

namespace phrenic::client {

// Returns the table of all commands.
CommandTable Commands();

// Each function adds the arguments of one command to `command` and returns the function that runs it. commands/x.cc
// holds the functions of the command x and its subcommands.
CommandFunction SetUpRun(CLI::App& command);
CommandFunction SetUpReplay(CLI::App& command);
CommandFunction SetUpPhysiology(CLI::App& command);
CommandFunction SetUpPatient(CLI::App& command);
CommandFunction SetUpPhantom(CLI::App& command);
CommandFunction SetUpScenes(CLI::App& command);
CommandFunction SetUpDescribe(CLI::App& command);
CommandFunction SetUpCreate(CLI::App& command);
CommandFunction SetUpFork(CLI::App& command);
CommandFunction SetUpSessions(CLI::App& command);
CommandFunction SetUpWatch(CLI::App& command);
CommandFunction SetUpSet(CLI::App& command);
CommandFunction SetUpPull(CLI::App& command);
CommandFunction SetUpPlay(CLI::App& command);
CommandFunction SetUpStep(CLI::App& command);
CommandFunction SetUpPause(CLI::App& command);
CommandFunction SetUpReset(CLI::App& command);
CommandFunction SetUpDelete(CLI::App& command);
CommandFunction SetUpControlShow(CLI::App& command);
CommandFunction SetUpControlTake(CLI::App& command);
CommandFunction SetUpControlHand(CLI::App& command);
CommandFunction SetUpControlLend(CLI::App& command);
CommandFunction SetUpControlRelease(CLI::App& command);
CommandFunction SetUpLinkCreate(CLI::App& command);
CommandFunction SetUpLinkList(CLI::App& command);
CommandFunction SetUpLinkRevoke(CLI::App& command);
CommandFunction SetUpExport(CLI::App& command);
CommandFunction SetUpExportsList(CLI::App& command);
CommandFunction SetUpExportsGet(CLI::App& command);
CommandFunction SetUpExportsDelete(CLI::App& command);
CommandFunction SetUpUpload(CLI::App& command);
CommandFunction SetUpStudyError(CLI::App& command);
CommandFunction SetUpStudyStability(CLI::App& command);
CommandFunction SetUpStudyCost(CLI::App& command);
CommandFunction SetUpStudyStreaming(CLI::App& command);
CommandFunction SetUpStudyList(CLI::App& command);
CommandFunction SetUpStudyWatch(CLI::App& command);
CommandFunction SetUpStudyDelete(CLI::App& command);
CommandFunction SetUpCampaignRun(CLI::App& command);
CommandFunction SetUpCampaignReport(CLI::App& command);
CommandFunction SetUpCampaignWork(CLI::App& command);
CommandFunction SetUpCompare(CLI::App& command);
CommandFunction SetUpInspect(CLI::App& command);
CommandFunction SetUpConvert(CLI::App& command);
CommandFunction SetUpDoctor(CLI::App& command);
CommandFunction SetUpCompletion(CLI::App& command);
CommandFunction SetUpMan(CLI::App& command);

}  // namespace phrenic::client

#endif  // PHRENIC_CLIENT_COMMANDS_COMMANDS_H_
