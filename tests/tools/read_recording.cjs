// Reads a recording by its index with npm's @mcap/core and prints the messages of each topic. Exit
// status 77: the packages are not installed.
const fs = require("fs");
let core, zstd;
try {
  core = require("@mcap/core");
  zstd = require("fzstd");
} catch (error) {
  process.exit(77);
}

async function main(path) {
  const file = await fs.promises.open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, length) => {
      const bytes = new Uint8Array(Number(length));
      await file.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await core.McapIndexedReader.Initialize({
    readable,
    decompressHandlers: { zstd: (bytes, size) => zstd.decompress(bytes, new Uint8Array(Number(size))) },
  });
  const counts = new Map();
  let last = -1n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    if (message.logTime < last) throw new Error("times go back");
    last = message.logTime;
    const topic = reader.channelsById.get(message.channelId).topic;
    counts.set(topic, (counts.get(topic) ?? 0) + 1);
  }
  for await (const attachment of reader.readAttachments()) console.log("attachment", attachment.name, attachment.data.length);
  for await (const metadata of reader.readMetadata()) console.log("metadata", metadata.name, metadata.metadata.size);
  for (const [topic, count] of counts) {
    const channel = [...reader.channelsById.values()].find((each) => each.topic === topic);
    console.log(count, topic, reader.schemasById.get(channel.schemaId).name, channel.messageEncoding);
  }
  if (reader.statistics.messageCount !== BigInt([...counts.values()].reduce((a, b) => a + b, 0)))
    throw new Error("statistics differ");
  // Every record in the order of the file, with its CRCs.
  const stream = new core.McapStreamReader({
    validateCrcs: true,
    decompressHandlers: { zstd: (bytes, size) => zstd.decompress(bytes, new Uint8Array(Number(size))) },
  });
  stream.append(fs.readFileSync(path));
  let records = 0;
  while (stream.nextRecord()) ++records;
  if (!stream.done()) throw new Error("not done");
  console.log(records, "records");
}

main(process.argv[2]).catch((error) => {
  console.error(error);
  process.exit(1);
});
