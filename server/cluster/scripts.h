// The keys of a cluster's sessions in Redis, and the Lua scripts that change them. Redis runs each script atomically.
//
//   phrenic:sessions        set      the ids of all sessions
//   phrenic:session:ID      hash     epoch: of its last owner
//                                    scene, moment, state: SavedScene, SavedMoment, SavedState
//                                    sequence: of the state; last: of the last journal entry
//                                    write: "EPOCH NUMBER" of the last kSave
//                                    a deleted session has epoch and deleted only
//   phrenic:journal:ID      hash     sequence -> SavedMoment, the entries since the state
//   phrenic:lease:ID        string   "EPOCH ADDRESS" of the server that has the session; expires
//   phrenic:servers         set      addresses
//   phrenic:server:ADDRESS  string   the number of its sessions; expires
//
// The epoch is a fencing token: every write names its epoch and has no effect once there is a later one.
//
// Redis::Run passes the arguments as ARGV[1] and so on, and turns numbers, strings and tables into a Reply. Times are
// of Redis' clock.
#ifndef PHRENIC_SERVER_CLUSTER_SCRIPTS_H_
#define PHRENIC_SERVER_CLUSTER_SCRIPTS_H_

namespace phrenic::cluster {

// Arguments: id, address, lease [ms]. Returns the epoch of a new session, or 0 if the session exists.
extern const char kClaim[];

// Arguments: id, address, lease [ms], the epoch and the sequence in the server's own store. Returns the next epoch; 0
// if another server has or had the session since, or if it was deleted.
extern const char kReclaim[];

// Arguments: id, address, lease [ms]. Takes the lease of a session without one. Returns epoch, scene, sequence, moment,
// state, and the journal as pairs of sequence and moment; {0} if the session has a lease, {-1} if it has no copy.
extern const char kTakeOver[];

// Arguments: address, lease [ms], "1" if this server takes sessions over, and pairs of id and epoch. Returns a number
// for each pair: 1 if the lease is renewed, 2 if it is renewed but Redis had lost the session, 0 if another server has
// it or it was deleted.
extern const char kRenew[];

// Arguments: id, epoch, a number that grows with each kSave of a server, scene or "", the state's sequence or "", its
// moment, the state, and pairs of sequence and moment. Returns 1, or 0 if there is a later epoch or the session was
// deleted. A write that comes after a later one of the same epoch, from a connection that had been given up, has no
// effect.
extern const char kSave[];

// Arguments: id, epoch, time that the deletion is remembered [s]. Returns 1, or 0 if there is a later epoch.
extern const char kDelete[];

// Arguments: id, epoch. Deletes the lease. Returns 0 if there is a later epoch or no lease.
extern const char kRelease[];

// Returns the ids of sessions without a lease, and the addresses of the servers that take sessions over.
extern const char kFindFree[];

// Argument: id. Returns {"EPOCH ADDRESS" or "", 1 if there is a copy to resume from}.
extern const char kLocate[];

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_SCRIPTS_H_
