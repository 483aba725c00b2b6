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
#ifndef PHRENIC_SERVER_CLUSTER_SCRIPTS_H_
#define PHRENIC_SERVER_CLUSTER_SCRIPTS_H_

namespace phrenic::cluster {

// Arguments: id, address, lease [ms]. Returns the epoch of a new session, or 0 if the session exists.
inline constexpr char kClaim[] = R"(
local id, address, lease = ARGV[1], ARGV[2], ARGV[3]
local session = 'phrenic:session:' .. id
if redis.call('EXISTS', 'phrenic:lease:' .. id) == 1 or redis.call('HEXISTS', session, 'state') == 1 then return 0 end
local epoch = redis.call('HINCRBY', session, 'epoch', 1)
redis.call('HDEL', session, 'deleted')
redis.call('PERSIST', session)
redis.call('SADD', 'phrenic:sessions', id)
redis.call('SET', 'phrenic:lease:' .. id, epoch .. ' ' .. address, 'PX', lease)
return epoch)";

// Arguments: id, address, lease [ms], the epoch and the sequence in the server's own store. Returns the next epoch; 0
// if another server has or had the session since, or if it was deleted.
inline constexpr char kReclaim[] = R"(
local id, address, lease = ARGV[1], ARGV[2], ARGV[3]
local own, sequence = tonumber(ARGV[4]), tonumber(ARGV[5])
local session = 'phrenic:session:' .. id
local held = redis.call('GET', 'phrenic:lease:' .. id)
if held and string.match(held, '^%d+ (.*)$') ~= address then return 0 end
local epoch = tonumber(redis.call('HGET', session, 'epoch') or -1)
if epoch > own then return 0 end
if epoch == own then
  if redis.call('HEXISTS', session, 'deleted') == 1 then return 0 end
  if tonumber(redis.call('HGET', session, 'last') or 0) > sequence then return 0 end
end
epoch = math.max(epoch, own) + 1
redis.call('HSET', session, 'epoch', epoch)
redis.call('SADD', 'phrenic:sessions', id)
redis.call('SET', 'phrenic:lease:' .. id, epoch .. ' ' .. address, 'PX', lease)
return epoch)";

// Arguments: id, address, lease [ms]. Takes the lease of a session without one. Returns epoch, scene, sequence, moment,
// state, and the journal as pairs of sequence and moment; {0} if the session has a lease, {-1} if it has no copy.
inline constexpr char kTakeOver[] = R"(
local id, address, lease = ARGV[1], ARGV[2], ARGV[3]
local session = 'phrenic:session:' .. id
if redis.call('EXISTS', 'phrenic:lease:' .. id) == 1 then return {0} end
if redis.call('HEXISTS', session, 'state') == 0 then
  redis.call('SREM', 'phrenic:sessions', id)
  return {-1}
end
local epoch = redis.call('HINCRBY', session, 'epoch', 1)
redis.call('SET', 'phrenic:lease:' .. id, epoch .. ' ' .. address, 'PX', lease)
local saved = redis.call('HMGET', session, 'scene', 'sequence', 'moment', 'state')
return {epoch, saved[1], saved[2], saved[3], saved[4], redis.call('HGETALL', 'phrenic:journal:' .. id)})";

// Arguments: address, lease [ms], "1" if this server takes sessions over, and pairs of id and epoch. Returns a number
// for each pair: 1 if the lease is renewed, 2 if it is renewed but Redis had lost the session, 0 if another server has
// it or it was deleted.
inline constexpr char kRenew[] = R"(
local address, lease = ARGV[1], ARGV[2]
if ARGV[3] == '1' then
  redis.call('SADD', 'phrenic:servers', address)
  redis.call('SET', 'phrenic:server:' .. address, (#ARGV - 3) / 2, 'PX', lease)
else
  redis.call('SREM', 'phrenic:servers', address)
end
local answers = {}
for i = 4, #ARGV, 2 do
  local id, own = ARGV[i], tonumber(ARGV[i + 1])
  local session = 'phrenic:session:' .. id
  local epoch = tonumber(redis.call('HGET', session, 'epoch') or -1)
  local answer = 0
  if epoch == own and redis.call('HEXISTS', session, 'deleted') == 0 then answer = 1 end
  if epoch < own then
    redis.call('HSET', session, 'epoch', own)
    answer = 2
  end
  if answer > 0 then
    redis.call('SADD', 'phrenic:sessions', id)
    redis.call('SET', 'phrenic:lease:' .. id, own .. ' ' .. address, 'PX', lease)
  end
  answers[#answers + 1] = answer
end
return answers)";

// Arguments: id, epoch, a number that grows with each kSave of a server, scene or "", the state's sequence or "", its
// moment, the state, and pairs of sequence and moment. Returns 1, or 0 if there is a later epoch or the session was
// deleted. A write that comes after a later one of the same epoch, from a connection that had been given up, has no
// effect.
inline constexpr char kSave[] = R"(
local id, own = ARGV[1], ARGV[2]
local session, journal = 'phrenic:session:' .. id, 'phrenic:journal:' .. id
if redis.call('HGET', session, 'epoch') ~= own or redis.call('HEXISTS', session, 'deleted') == 1 then return 0 end
local epoch, number = string.match(redis.call('HGET', session, 'write') or '', '^(%d+) (%d+)$')
if epoch == own and tonumber(number) >= tonumber(ARGV[3]) then return 1 end
redis.call('HSET', session, 'write', own .. ' ' .. ARGV[3])
if ARGV[4] ~= '' then redis.call('HSET', session, 'scene', ARGV[4]) end
if ARGV[5] ~= '' then
  redis.call('HSET', session, 'sequence', ARGV[5], 'last', ARGV[5], 'moment', ARGV[6], 'state', ARGV[7])
  redis.call('DEL', journal)
end
for i = 8, #ARGV, 2 do
  redis.call('HSET', journal, ARGV[i], ARGV[i + 1])
  redis.call('HSET', session, 'last', ARGV[i])
end
return 1)";

// Arguments: id, epoch, time that the deletion is remembered [s]. Returns 1, or 0 if there is a later epoch.
inline constexpr char kDelete[] = R"(
local id, own = ARGV[1], ARGV[2]
local session = 'phrenic:session:' .. id
if redis.call('HGET', session, 'epoch') ~= own then return 0 end
redis.call('DEL', session, 'phrenic:journal:' .. id, 'phrenic:lease:' .. id)
redis.call('SREM', 'phrenic:sessions', id)
redis.call('HSET', session, 'epoch', own, 'deleted', 1)
redis.call('EXPIRE', session, ARGV[3])
return 1)";

// Arguments: id, epoch. Deletes the lease. Returns 0 if there is a later epoch or no lease.
inline constexpr char kRelease[] = R"(
if redis.call('HGET', 'phrenic:session:' .. ARGV[1], 'epoch') ~= ARGV[2] then return 0 end
return redis.call('DEL', 'phrenic:lease:' .. ARGV[1]))";

// Returns the ids of sessions without a lease, and the addresses of the servers that take sessions over.
inline constexpr char kFindFree[] = R"(
local free, servers = {}, {}
for _, id in ipairs(redis.call('SMEMBERS', 'phrenic:sessions')) do
  if redis.call('EXISTS', 'phrenic:lease:' .. id) == 0 then free[#free + 1] = id end
end
for _, address in ipairs(redis.call('SMEMBERS', 'phrenic:servers')) do
  if redis.call('EXISTS', 'phrenic:server:' .. address) == 1 then servers[#servers + 1] = address
  else redis.call('SREM', 'phrenic:servers', address) end
end
return {free, servers})";

// Argument: id. Returns {"EPOCH ADDRESS" or "", 1 if there is a copy to resume from}.
inline constexpr char kLocate[] = R"(
return {redis.call('GET', 'phrenic:lease:' .. ARGV[1]) or '',
        redis.call('HEXISTS', 'phrenic:session:' .. ARGV[1], 'state')})";

}  // namespace phrenic::cluster

#endif  // PHRENIC_SERVER_CLUSTER_SCRIPTS_H_
