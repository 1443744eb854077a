/** Messages of recordings: English, Japanese. */
export const replay = {
  "replay.title": ["Replays", "リプレイ"],
  "replay.choose": ["Open a recording on this machine", "この端末の記録ファイルを開く"],
  "replay.dropHint": [
    "or drop .mcap files anywhere on this page. If a match has several parts, drop them together",
    "または .mcap ファイルをこのページにドロップ（1 試合が複数に分かれている場合はまとめて）",
  ],
  "replay.drop": ["Drop to play", "ドロップして再生"],
  "replay.onServer": ["Recordings on the server", "サーバーの記録"],
  "replay.noneYet": [
    "No match was recorded here yet. A match appears here once its result is official.",
    "記録された試合はまだありません。結果が確定した試合がここに表示されます。",
  ],
  "replay.where": ["court {court}, match {number}", "コート {court}・第 {number} 試合"],
  "replay.noList": [
    "The server's list can't be loaded. You can still open files on this machine.",
    "サーバーの一覧を取得できません。この端末のファイルは開けます。",
  ],
  "replay.loading": ["Loading {name} …", "{name} を読み込んでいます…"],
  "replay.reading": ["Reading the match …", "試合を読み取っています…"],
  "replay.others": ["Other recordings", "ほかの記録"],
  "replay.play": ["Play", "再生"],
  "replay.pause": ["Pause", "一時停止"],
  "replay.playKey": ["{what} (Space)", "{what}（スペース）"],
  "replay.back": ["One beat back (,)", "1 ビート戻る（,）"],
  "replay.ahead": ["One beat ahead (.)", "1 ビート進む（.）"],
  "replay.previous": ["Previous event (P)", "前のイベント（P）"],
  "replay.next": ["Next event (N)", "次のイベント（N）"],
  "replay.speed": ["Speed (- and +)", "速度（- と +）"],
  "replay.seek": ["Position in the match", "試合の再生位置"],
  "replay.position": ["{time} of {total}", "{total} 中 {time}"],
  "replay.beat": ["beat {beat}", "ビート {beat}"],
  "replay.share": ["Copy the address of this moment", "この場面の URL をコピー"],
  "replay.shared": ["The address of this moment is copied", "この場面の URL をコピーしました"],
  "replay.notShared": [
    "Recordings on this machine have no address: give others the file",
    "この端末のファイルには URL がありません。ほかの人に見せるには、ファイルを渡してください",
  ],
  "replay.transport": ["Playback", "再生操作"],
  "replay.noteCut": [
    "{file} stops at beat {beat}: it was never closed, or not copied completely. The part that exists is shown.",
    "{file} はビート {beat} で途切れています（記録が終了していないか、コピーが不完全です）。残っている部分を再生します。",
  ],
  "replay.noteDamaged": [
    "{file} is damaged after beat {beat}. The part before that is shown. Copy the file again from where it was recorded.",
    "{file} はビート {beat} より後が壊れています。それより前を再生します。元の場所からコピーし直してください。",
  ],
  "replay.noteGap": [
    "Part {segment} of this match is missing: drop all its files together.",
    "この試合のパート {segment} がありません。すべてのファイルをまとめてドロップしてください。",
  ],
  "replay.fork": [
    "What if: this is a fork of {match} at beat {beat}, not an official record.",
    "もしも：これは {match} のビート {beat} からの分岐です。公式の記録ではありません。",
  ],
  "replay.forkShort": ["What if", "もしも"],
  "replay.beside": ["Show the match beside it", "元の試合を並べて見る"],
  "replay.alone": ["Show the fork alone", "分岐だけを見る"],
  "replay.besideFork": ["The fork", "分岐"],
  "replay.besideOrigin": ["The match", "元の試合"],
  "odds.title": ["Odds", "勝率"],
  "odds.now": ["{first} : {second} %", "{first} : {second} %"],
  "odds.about": [
    "The chance to win if bots took over both robots here: what the position is worth, not who plays better",
    "ここからボットが両方のロボットを引き継いだ場合の勝率です。局面の価値を表し、操作のうまさは表しません",
  ],
  "odds.curve": [
    "Odds during the match: left team above, right team below",
    "試合中の勝率（上が左のチーム、下が右のチーム）",
  ],
  "odds.highlights": ["Highlights", "ハイライト"],
  "odds.swing": ["{team}: {before} → {after} %", "{team}：{before} → {after} %"],
  "replay.noteHide": ["Hide", "閉じる"],
  "replay.bad.notMcap": [
    "{name} is not a LACOC record, because it is not an MCAP file. Choose the .mcap of a match.",
    "{name} は LACOC の記録ではありません（MCAP ファイルではありません）。試合の .mcap を選んでください。",
  ],
  "replay.bad.notLacoc": [
    "{name} is an MCAP file, but not a LACOC record. Choose the .mcap of a match (a file exported for Foxglove can't be read here).",
    "{name} は MCAP ファイルですが、LACOC の記録ではありません。試合の .mcap を選んでください（Foxglove 用に書き出したものは読み込めません）。",
  ],
  "replay.bad.format": [
    "{name} has format {format}, and this page reads format {ours}. Open it with the version of LACOC that wrote it ({version}).",
    "{name} の形式は {format} ですが、このページが読めるのは形式 {ours} です。記録した版の LACOC（{version}）で開いてください。",
  ],
  "replay.bad.noHeader": [
    "{name} contains no match. A record begins with a header, and this file has none.",
    "{name} に試合がありません（記録の先頭にあるはずのヘッダーがありません）。",
  ],
  "replay.bad.otherMatch": [
    "{name} belongs to match {match}, but another file belongs to {other}. Choose the files of one match.",
    "{name} は試合 {match} のもの、ほかのファイルは {other} のものです。1 つの試合のファイルだけを選んでください。",
  ],
  "replay.bad.nothing": [
    "{name} has no picture of the match. It stops before the first one.",
    "{name} には試合の映像がありません（最初の 1 枚より前で途切れています）。",
  ],
  "replay.bad.missing": [
    "The server does not have the recording {name}, or no longer has it.",
    "サーバーに記録 {name} がありません。",
  ],
  "replay.bad.unreachable": [
    "The server does not answer. Try again, or open a file on this machine.",
    "サーバーが応答しません。もう一度試すか、この端末のファイルを開いてください。",
  ],
  "replay.bad.unreadable": [
    "{name} can't be read. If it is a folder, drop the files in it instead.",
    "{name} を読み込めません。フォルダーではなく、中のファイルをドロップしてください。",
  ],
  "replay.bad.fault": [
    "The recording can't be read ({error}). Load this page again.",
    "記録を読み込めません（{error}）。ページを再読み込みしてください。",
  ],
} as const satisfies Record<string, readonly [string, string]>;
