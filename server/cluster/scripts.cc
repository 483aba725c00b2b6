#include "server/cluster/scripts.h"

namespace phrenic::cluster {

const char kClaim[] = R"(
local id, address, lease = ARGV[1], ARGV[2], ARGV[3]
local session = 'phrenic:session:' .. id
if redis.call('EXISTS', 'phrenic:lease:' .. id) == 1 or redis.call('HEXISTS', session, 'state') == 1 then return 0 end
local epoch = redis.call('HINCRBY', session, 'epoch', 1)
redis.call('HDEL', session, 'deleted')
redis.call('PERSIST', session)
redis.call('SADD', 'phrenic:sessions', id)
redis.call('SET', 'phrenic:lease:' .. id, epoch .. ' ' .. address, 'PX', lease)
return epoch)";

const char kReclaim[] = R"(
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

const char kTakeOver[] = R"(
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

const char kRenew[] = R"(
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

const char kSave[] = R"(
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

const char kDelete[] = R"(
local id, own = ARGV[1], ARGV[2]
local session = 'phrenic:session:' .. id
if redis.call('HGET', session, 'epoch') ~= own then return 0 end
redis.call('DEL', session, 'phrenic:journal:' .. id, 'phrenic:lease:' .. id)
redis.call('SREM', 'phrenic:sessions', id)
redis.call('HSET', session, 'epoch', own, 'deleted', 1)
redis.call('EXPIRE', session, ARGV[3])
return 1)";

const char kRelease[] = R"(
if redis.call('HGET', 'phrenic:session:' .. ARGV[1], 'epoch') ~= ARGV[2] then return 0 end
return redis.call('DEL', 'phrenic:lease:' .. ARGV[1]))";

const char kFindFree[] = R"(
local free, servers = {}, {}
for _, id in ipairs(redis.call('SMEMBERS', 'phrenic:sessions')) do
  if redis.call('EXISTS', 'phrenic:lease:' .. id) == 0 then free[#free + 1] = id end
end
for _, address in ipairs(redis.call('SMEMBERS', 'phrenic:servers')) do
  if redis.call('EXISTS', 'phrenic:server:' .. address) == 1 then servers[#servers + 1] = address
  else redis.call('SREM', 'phrenic:servers', address) end
end
return {free, servers})";

const char kLocate[] = R"(
return {redis.call('GET', 'phrenic:lease:' .. ARGV[1]) or '',
        redis.call('HEXISTS', 'phrenic:session:' .. ARGV[1], 'state')})";

}  // namespace phrenic::cluster
