/**
 * The court's English sentences in Japanese: patterns with holes, the first that fits.
 *
 * A hole takes what stands there: `{team}` as it is, `{#n}` a number, `{Word}` (with a capital)
 * something that is itself said in Japanese, `{Words}` a list of such. What no pattern knows stays
 * English: tests/pages/test_japanese.py holds the patterns against all that a court can say.
 */

type Pattern = readonly [english: string, japanese: string];

/** Words that stand within other sentences, and alone. */
const WORDS: readonly Pattern[] = [
  ["CREATED", "準備中"],
  ["LOBBY", "待機中"],
  ["READY", "準備完了"],
  ["COUNTDOWN", "カウントダウン"],
  ["PLAYING", "試合中"],
  ["HALTED", "中断"],
  ["FINISHED", "試合終了"],
  ["OFFICIAL", "結果確定"],
  ["VOID", "無効試合"],
  ["left", "左"],
  ["right", "右"],
  ["solo", "単独"],
  ["draw", "引き分け"],
  ["neutral", "無所属"],
  ["down", "倒れた状態"],
  ["points", "点"],
  ["s", "秒"],
  ["flip", "ディスクの反転"],
  ["capture", "コーナーの獲得"],
  ["strike", "フラッグを倒した記録"],
  ["ready", "代理の準備完了"],
  ["start", "開始"],
  ["halt", "中断"],
  ["resume", "再開"],
  ["restart", "再スタート"],
  ["freeze", "停止"],
  ["unfreeze", "停止解除"],
  ["adjust", "得点の修正"],
  ["set", "盤面の修正"],
  ["take-back", "取り消し"],
  ["clock", "時計の修正"],
  ["abort", "無効試合"],
  ["declare", "勝者の宣言"],
  ["official", "結果の確定"],
  ["next", "次の試合"],
];

/** What stands around another sentence; these come first. */
const FRAMES: readonly Pattern[] = [
  ["Referee {by}: {Sentence} Reason: {Reason}", "審判 {by}：{Sentence}理由：{Reason}"],
  ["Referee {by}: {Sentence}", "審判 {by}：{Sentence}"],
  ["Judged again: {Sentence}", "再判定：{Sentence}"],
  // The reasons that the referee's page offers; the rest of a reason is free text.
  ["fell over: {words}", "転倒（{words}）"],
  ["stuck: {words}", "動けない（{words}）"],
  ["network: {words}", "通信（{words}）"],
  ["rule: {words}", "規則（{words}）"],
  ["fell over", "転倒"],
  ["stuck", "動けない"],
  ["network", "通信"],
  ["rule", "規則"],
  ["the court was started again", "コートの再起動"],
  ["the court was started again, with another arithmetic", "演算の異なる環境でのコートの再起動"],
  ["physics stopped", "物理計算の停止"],
  ["Replay advised: {Reasons}.", "再試合を推奨します：{Reasons}。"],
];

/** How well a match was held (lacoc_server/court/health.py), and its record (record/writer.py). */
const HEALTH: readonly Pattern[] = [
  ["A replay is not advised any more.", "再試合の推奨を取り下げました。"],
  [
    "it ran at {#n} of real time, at least {#least} is wanted",
    "実時間比 {#n}（基準は {#least} 以上）",
  ],
  [
    "{#n} % of the beats were slow, at most {#most} % may be",
    "処理の遅れが {#n} %（基準は {#most} % 以下）",
  ],
  [
    "a beat began {#n} ms late, at most {#most} ms may be",
    "最大 {#n} ミリ秒の遅れ（基準は {#most} ミリ秒以下）",
  ],
  [
    "seat {Seat} was silent for {#n} s, at most {#most} s may be",
    "{Seat}の席の通信が {#n} 秒途絶（基準は {#most} 秒以下）",
  ],
  [
    "{#n} % of the repeats of seat {Seat} arrived, at least {#least} % are wanted",
    "{Seat}の席からの送信の {#n} % が到着（基準は {#least} % 以上）",
  ],
  [
    "physics stopped {#n} times, at most {#most} may be",
    "物理計算が {#n} 回停止（基準は {#most} 回以下）",
  ],
  [
    "the court was started again {#n} times, at most {#most} may be",
    "コートを {#n} 回再起動（基準は {#most} 回以下）",
  ],
  [
    "The record {file} can't be written: {why}. {#n} bytes wait in memory: make room on its disk.",
    "記録 {file} に書き込めません（{why}）。{#n} バイトがメモリーで待っています。ディスクの空きを増やしてください。",
  ],
  [
    "The disk of the record {file} reports: {why}. A power cut may lose a part of the record: check that disk.",
    "記録 {file} のディスクのエラー：{why}。停電時に記録の一部が失われるおそれがあります。ディスクを確認してください。",
  ],
];

/** What the match tells: the log (lacoc_server/match/match.py, contestant.py, the games). */
const EVENTS: readonly Pattern[] = [
  ["LOBBY.", "チームの参加を待っています。"],
  ["READY.", "両チームの準備が完了しました。"],
  ["COUNTDOWN.", "カウントダウンを始めます。"],
  ["PLAYING.", "プレー開始。"],
  ["HALTED.", "中断しました。"],
  ["FINISHED: {Why}.", "試合終了：{Why}。"],
  ["OFFICIAL.", "結果が確定しました。"],
  ["VOID.", "無効試合になりました。"],
  ["time is up", "時間切れ"],
  ["the left team has no disc left", "左チームのディスクがなくなりました"],
  ["the right team has no disc left", "右チームのディスクがなくなりました"],
  ["the left team holds all corners", "左チームがすべてのコーナーを獲得しました"],
  ["the right team holds all corners", "右チームがすべてのコーナーを獲得しました"],
  ["ended by the referee", "審判が終了させました"],
  ["aborted by the referee", "審判が打ち切りました"],
  ["everybody has left", "全員が退出しました"],
  ["nobody has been heard for {#n} minutes", "{#n} 分間、誰からも通信がありません"],
  ["By the rules: {Result}, {score}.", "規則による結果：{Result}（{score}）"],
  ["a draw", "引き分け"],
  ["{team} wins", "{team} の勝ち"],
  ["Physics stopped: {Why}.", "物理計算が止まりました：{Why}。"],
  ["a position became not a number or too large", "位置が計算できない値になりました"],
  ["a velocity became not a number or too large", "速度が計算できない値になりました"],
  ["an acceleration became not a number or too large", "加速度が計算できない値になりました"],
  ["a commanded angle was not a number", "指令角度が数値ではありません"],
  ["too many contacts", "接触が多すぎます"],
  ["too many constraints", "拘束が多すぎます"],
  ["the inertia matrix is singular", "慣性行列が特異です"],
  ["MuJoCo's warning {#n}", "MuJoCo の警告 {#n}"],
  [
    "{team} takes the {Seat} seat with {robot}.",
    "{team} が{Seat}の席に着きました（ロボット：{robot}）。",
  ],
  ["{team} is back.", "{team} が戻りました。"],
  ["{team} is ready.", "{team} の準備が完了しました。"],
  ["{team} is not ready after all.", "{team} が準備完了を取り消しました。"],
  ["{team} leaves the {Seat} seat.", "{team} が{Seat}の席を離れました。"],
  ["{team} has left; the seat stays theirs.", "{team} が退出しました（席はそのままです）。"],
  [
    "{team} is not heard any more: it stands.",
    "{team} の通信が途絶えました。ロボットは停止しています。",
  ],
  ["{team} is heard again.", "{team} の通信が回復しました。"],
  ["{team} goes back to the start.", "{team} がスタート位置に戻ります。"],
  [
    "{team} left its start place by {#n} m: it is put back.",
    "{team} がスタート位置から {#n} m 動いたため、元の位置に戻されます。",
  ],
  [
    "{team} left its start place {#n} times: it is not ready.",
    "{team} がスタート位置から {#n} 回動いたため、準備完了が取り消されました。",
  ],
  ["{team} flips {disc} and with it {discs}.", "{team} が {disc} を反転、続いて {discs} も反転。"],
  ["{team} flips {disc}.", "{team} が {disc} を反転。"],
  ["{team} takes {corner} for {#n} point.", "{team} が {corner} を獲得（{#n} 点）。"],
  ["{team} strikes {flag} for {#n} point.", "{team} が {flag} を倒しました（{#n} 点）。"],
  ["{team} takes {corner} for {#n} points.", "{team} が {corner} を獲得（{#n} 点）。"],
  ["{team} strikes {flag} for {#n} points.", "{team} が {flag} を倒しました（{#n} 点）。"],
  ["{team} strikes {flag} for 1 point.", "{team} が {flag} を倒しました（1 点）。"],
  ["{team} takes {corner} for 1 point.", "{team} が {corner} を獲得（1 点）。"],
];

/** What the disk says (lacoc_shared/record/writer.py). */
const DISK: readonly Pattern[] = [
  [
    "The record {name} can't be written: {why}. Make room on its disk.",
    "記録 {name} に書き込めません（{why}）。ディスクの空きを増やしてください。",
  ],
  [
    "The disk of the record {name} reports: {why}. A power cut may lose a part of the record: check that disk.",
    "記録 {name} のディスクがエラーを報告しました（{why}）。停電すると記録の一部が失われるおそれがあります。ディスクを確かめてください。",
  ],
  [
    "No record can be written to {folder}: {why}. Make room there, or name another folder.",
    "{folder} に記録を書き込めません（{why}）。空きを増やすか、別のフォルダーを指定してください。",
  ],
  [
    "No record can be written to {folder}: {why}. Name a folder that this user may write to.",
    "{folder} に記録を書き込めません（{why}）。書き込めるフォルダーを指定してください。",
  ],
  [
    "The record {name} is there already, and a record is never overwritten.",
    "記録 {name} はすでにあり、上書きしません。",
  ],
];

/** What a referee decides, and why it can't be (lacoc_server/match/referee.py). */
const DECISIONS: readonly Pattern[] = [
  ["ready for {team}.", "{team} の代わりに準備完了としました。"],
  ["play begins in {#n} s.", "{#n} 秒後に試合を開始します。"],
  ["play goes on in {#n} s.", "{#n} 秒後に試合を再開します。"],
  ["halted.", "試合を中断しました。"],
  ["{team} is frozen for {#n} s.", "{team} を {#n} 秒間停止させました。"],
  ["{team} may move again.", "{team} の停止を解除しました。"],
  ["{#n} for {team}.", "{team} の得点に {#n} 点。"],
  ["{marker} is set to {State}.", "{marker} を「{State}」にしました。"],
  ["the clock moves by {#n} s.", "時計を {#n} 秒動かしました。"],
  ["the match is void.", "無効試合としました。"],
  ["the match is declared a draw.", "引き分けと宣言しました。"],
  ["{team} is declared the winner.", "{team} を勝者と宣言しました。"],
  ["the result is official: {Winner}.", "結果を確定しました：{Winner}。"],
  ["the next match opens.", "次の試合を始めます。"],
  ["event {#n} is taken back.", "{#n} 番の記録を取り消しました。"],
  ["event {#n} vanishes: {Kind} {marker}", "{#n} 番が消えます：{Kind}（{marker}）"],
  ["appears: {Kind} {marker}", "新しく記録されます：{Kind}（{marker}）"],
  [
    "only in {Phases}; the match is {Phase}; {Reasons}",
    "{Phases}のときだけ可能です（現在は{Phase}）。{Reasons}",
  ],
  ["only in {Phases}; the match is {Phase}", "{Phases}のときだけ可能です（現在は{Phase}）"],
  ["nobody has joined {Seat}", "{Seat}の席にはまだ誰も参加していません"],
  ["{seat} ({team}) has not said ready", "{team} がまだ準備完了していません"],
  ["this game has no board", "この競技には盤面がありません"],
  ["nobody has joined", "まだ誰も参加していません"],
  ["this match has no end", "この試合には時間制限がありません"],
  ["give a reason; it goes into the record.", "理由を入力してください（記録に残ります）。"],
  [
    "there is no seat {seat}; there are {seats}.",
    "{seat} という席はありません（{seats} があります）。",
  ],
  [
    "{#n} {Unit}? Give a number between {#low} and {#high}, not 0.",
    "{#n} {Unit}は指定できません。{#low} から {#high} までの 0 以外の数を指定してください。",
  ],
  ["{#n} s is less than a tick of 20 ms.", "{#n} 秒は 1 ティック（20 ミリ秒）より短いです。"],
  [
    "{#n} s? Freeze for more than 0 and at most 600 s.",
    "{#n} 秒は指定できません。0 秒より長く 600 秒以下にしてください。",
  ],
  ["{team} is not frozen.", "{team} は停止させられていません。"],
  [
    "there is no {marker} on this board; there are {markers}.",
    "この盤面に {marker} はありません（{markers} があります）。",
  ],
  [
    "{state} is no state; there are {states}.",
    "{state} という状態はありません（{states} があります）。",
  ],
  [
    "{winner} can't win; there are {choices}.",
    "{winner} は勝者にできません（{choices} から選べます）。",
  ],
  [
    "event {#n} can't be taken back: give the number of a capture, flip, strike, adjust or set that stands.",
    "{#n} 番の記録は取り消せません。有効な獲得・反転・フラッグ・得点修正・盤面修正の番号を指定してください。",
  ],
  ["a disc is neutral, left or right", "ディスクは「無所属」「左」「右」のいずれかです"],
  ["a corner is neutral, left or right", "コーナーは「無所属」「左」「右」のいずれかです"],
  ["practice has no markers", "練習には盤面がありません"],
  ["This is not a referee's token of this court.", "このコートの審判用トークンではありません。"],
  ["Say who decides: it stands in the record.", "審判の名前を入力してください（記録に残ります）。"],
  ["A number of the decision {Decision} is beyond all reason.", "{Decision}の数値が大きすぎます。"],
  [
    "The decision was not understood: {error}. There are: {decisions}.",
    "判定を読み取れませんでした：{error}。使えるもの：{decisions}",
  ],
  ["The decision was not understood: {error}.", "判定を読み取れませんでした：{error}"],
];

/** What a contestant is told (contestant.py, inbox.py, shared/seat.py, the client's controller). */
const CONTESTANTS: readonly Pattern[] = [
  ["keys work only while the match is being played", "キーは試合中だけ使えます"],
  ["this arena does not open that level of control", "この競技ではその操作レベルは使えません"],
  ["your gait file has no such key", "歩容ファイルにそのキーはありません"],
  [
    "your robot was restarted a moment ago: wait until the pause is over",
    "再スタート直後です。待ち時間が終わるまでお待ちください",
  ],
  ["the referee has frozen your robot", "審判がロボットを停止させています"],
  ["the court refused it", "コートに拒否されました"],
  [
    "The match is on ({Phase}): join when the next one opens.",
    "試合が進行しています（{Phase}）。次の試合が始まったら参加してください。",
  ],
  ["The match is on ({Phase}).", "試合が進行しています（{Phase}）。"],
  [
    "This match is over: you play in the next.",
    "この試合は終わっています。次の試合から参加できます。",
  ],
  [
    "The match is on with the files that it began with; the next takes your new ones.",
    "この試合は開始時のファイルのまま続きます。新しいファイルは次の試合から使われます。",
  ],
  ["Your files have mistakes.", "ファイルに誤りがあります。"],
  ["Your file has 1 mistake.", "ファイルに誤りが 1 か所あります。"],
  [
    "Your files have {#n} mistakes; the first {#most} follow.",
    "ファイルに誤りが {#n} か所あります。最初の {#most} か所を示します。",
  ],
  ["Your files have {#n} mistakes.", "ファイルに誤りが {#n} か所あります。"],
  ["Nobody has joined the {Seat} seat.", "{Seat}の席にはまだ誰も参加していません。"],
  ["The seat stays yours.", "席はあなたのものとして残ります。"],
  [
    "The court does not know this session: join seat {Seat} again.",
    "コートがこの接続を認識できません。{Seat}の席にもう一度参加してください。",
  ],
  [
    "Seat {Seat} was joined again from another window or machine.",
    "{Seat}の席に、別のウィンドウまたは端末から参加がありました。",
  ],
  [
    "seat {Seat} was joined again from another window or machine",
    "{Seat}の席に、別のウィンドウまたは端末から参加がありました",
  ],
  [
    "This session has left seat {Seat}: join again.",
    "この接続は{Seat}の席を離れました。もう一度参加してください。",
  ],
  ["This session holds another seat than {Seat}.", "この接続は{Seat}とは別の席のものです。"],
  [
    "This court speaks version {#ours} of the protocol, your program version {#yours}: install the version of lacoc that the organiser uses.",
    "コートの通信方式は第 {#ours} 版、お使いのプログラムは第 {#yours} 版です。主催者と同じ版の lacoc を入れてください。",
  ],
  [
    "This request has come before, or a newer one has.",
    "この要求、またはより新しい要求がすでに届いています。",
  ],
  ["The join was not understood: {error}.", "参加の要求を読み取れませんでした：{error}"],
  ["The request was not understood: {error}.", "要求を読み取れませんでした：{error}"],
  [
    "This token does not open seat {Seat}. Check the seat and the token that the organiser gave you.",
    "このトークンでは{Seat}の席に着けません。主催者から渡された席とトークンを確かめてください。",
  ],
  ["Too many joins at once: wait a few seconds.", "参加の要求が多すぎます。数秒お待ちください。"],
  [
    "Ready and not ready too often: wait a few seconds.",
    "準備完了とその取り消しが多すぎます。数秒お待ちください。",
  ],
  [
    "A team's name has 1-{#most} printable characters; found {name}.",
    "チーム名は 1～{#most} 文字で、表示できる文字だけを使ってください（入力：{name}）。",
  ],
  [
    "A file's name has 1-{#most} printable characters: rename it.",
    "ファイル名は 1～{#most} 文字で、表示できる文字だけを使ってください。名前を変えてください。",
  ],
  [
    "The request's seal is not that of seat {Seat}: join again.",
    "要求の署名が{Seat}の席のものではありません。もう一度参加してください。",
  ],
  [
    "Your files are too large together: {#size} KiB, at most {#most} KiB travel. Shorten the gait files.",
    "ファイルの合計が大きすぎます（{#size} KiB、上限 {#most} KiB）。歩容ファイルを短くしてください。",
  ],
  [
    "Seat {Seat} is not yours now ({Reason}).",
    "{Seat}の席は今あなたのものではありません（{Reason}）。",
  ],
  ["not joined", "参加していません"],
  ["held", "参加中"],
  ["replaced", "別の場所からの参加に置き換わりました"],
  ["refused", "拒否されました"],
  ["the court does not answer", "コートが応答しません"],
  ["the court does not accept the files any more", "コートがファイルを受け付けなくなりました"],
  ["court silent for {#n} s", "コートから {#n} 秒間応答がありません"],
  [
    "Court {court} has no seat {seat}; it has {seats}.",
    "コート {court} に {seat} という席はありません（{seats} があります）。",
  ],
  [
    "Court {court} at {address} does not answer. Is it overloaded or stopped?",
    "コート {court}（{address}）が応答しません。過負荷か停止の可能性があります。",
  ],
  [
    "There is no court {court} at {address}; there is {courts}.",
    "{address} にコート {court} はありません（{courts} があります）。",
  ],
  [
    "No court answers at {address}. Is it running?",
    "{address} のコートが応答しません。起動していますか。",
  ],
  [
    "The court's answer is not understood ({error}). This program speaks version {#n} of the protocol: install the version of lacoc that the organiser uses.",
    "コートの応答を読み取れません（{error}）。このプログラムの通信方式は第 {#n} 版です。主催者と同じ版の lacoc を入れてください。",
  ],
];

/** What a court counts of what it did not believe (lacoc_server/doors/sessions.py). */
const COUNTED: readonly Pattern[] = [
  ["bad bytes", "読み取れないデータ"],
  ["too long", "長すぎるデータ"],
  ["stale", "古い画面への応答の繰り返し"],
  ["unknown session", "不明な接続"],
  ["not your seat", "別の席のもの"],
  ["bad seal", "署名の誤り"],
  ["old", "古いもの"],
  ["out of range", "範囲外の値"],
  ["ahead", "まだ届いていない画面への応答"],
  ["flood", "送りすぎ"],
  ["wrong token", "トークンの誤り"],
  ["wrong version", "版の違い"],
  ["bad name", "名前の誤り"],
  ["bad files", "ファイルの誤り"],
  ["bad decision", "判定の誤り"],
];

/** Mistakes in gait files: what was expected, what was found (shared/gait_*.py, entry.py). */
const GAITS: readonly Pattern[] = [
  ["a table of angles", "角度の表"],
  [
    '"Num of Posture" and their number (Loco-data), or the number of keys alone (LocoTra-data)',
    "「Num of Posture」とその数（Loco-data）、またはキーの数だけの行（LocoTra-data）",
  ],
  ['"Num of Posture" and their number (Loco-data)', "「Num of Posture」とその数（Loco-data）"],
  ["a gait (Loco-data or LocoTra-data)", "歩容（Loco-data または LocoTra-data）"],
  ["the path of a robot (Pos-data)", "ロボットの軌跡（Pos-data）"],
  [
    "tabs: save it as text with tabs, or as .xlsx",
    "タブ区切り（タブ区切りのテキストか .xlsx で保存してください）",
  ],
  ["commas or semicolons between the cells (CSV)", "コンマまたはセミコロンで区切られたセル（CSV）"],
  ["the table saved as .xlsx, or as text with tabs", ".xlsx かタブ区切りのテキストで保存した表"],
  ["an OpenDocument file, such as .ods", ".ods などの OpenDocument ファイル"],
  ["a Word document (.docx)", "Word 文書（.docx）"],
  ["a presentation (.pptx)", "プレゼンテーション（.pptx）"],
  ["a binary workbook (.xlsb)", "バイナリ形式のブック（.xlsb）"],
  ["as many rows as announced for key [{#n}]", "キー [{#n}] に書かれた数だけの行"],
  ["as many rows as announced", "書かれた数だけの行"],
  ["as many keys as announced", "書かれた数だけのキー"],
  ['a key from "0 Key" to "9 Key"', "「0 Key」から「9 Key」までのキー"],
  ["each key once", "各キーは 1 回だけ"],
  [
    "the number of postures of key [0] alone, before its postures",
    "キー [0] の姿勢の前に、その姿勢の数だけの行",
  ],
  ["nothing after {What}", "{What}の後は空欄"],
  ["{What}, a whole number from 1 to {#n}", "{What}（1 から {#n} までの整数）"],
  ["the number of postures of key [{#n}]", "キー [{#n}] の姿勢の数"],
  ["the number of postures", "姿勢の数"],
  ["the number of keys", "キーの数"],
  [
    "{#n} angles a row: this robot has {#legs} legs",
    "1 行に {#n} 個の角度（このロボットは {#legs} 脚です）",
  ],
  [
    "{#n} angles ({#each} for each of {#legs} legs)",
    "{#n} 個の角度（{#legs} 脚に {#each} 個ずつ）",
  ],
  ["an angle from {#low} to {#high} degrees", "{#low} 度から {#high} 度までの角度"],
  ["a gait of at most {#n} rows", "{#n} 行以下の歩容"],
  ["{#n} rows", "{#n} 行"],
  ["a gait file of at most 32 KiB", "32 KiB 以下の歩容ファイル"],
  ["text in UTF-8, UTF-16 or Shift-JIS", "UTF-8、UTF-16、Shift-JIS のいずれかのテキスト"],
  [
    "an .xlsx workbook without a password, as spreadsheet programs save it",
    "表計算ソフトで保存した、パスワードのない .xlsx ファイル",
  ],
  [
    '"Num of Posture" in cell A1 (Loco-data); sequences are a text file (LocoTra-data.txt)',
    "セル A1 の「Num of Posture」（Loco-data）。動作はテキスト（LocoTra-data.txt）に書きます",
  ],
  ["a workbook of at most 1 MiB", "1 MiB 以下のブック"],
  ['a sheet "{sheet}", or "{other}" alone', "シート「{sheet}」、または「{other}」だけのブック"],
  [
    "a Loco-data file (postures for level A) or a LocoTra-data file (sequences for level B; 'lacoc gait convert Loco-data.xlsx LocoTra-data.txt' makes one)",
    "Loco-data ファイル（レベル A の姿勢）または LocoTra-data ファイル（レベル B の動作。「lacoc gait convert Loco-data.xlsx LocoTra-data.txt」で作れます）",
  ],
  ["a Loco-data file (postures for level A)", "Loco-data ファイル（レベル A の姿勢）"],
  [
    "a LocoTra-data file (sequences for level B; 'lacoc gait convert Loco-data.xlsx LocoTra-data.txt' makes one)",
    "LocoTra-data ファイル（レベル B の動作。「lacoc gait convert Loco-data.xlsx LocoTra-data.txt」で作れます）",
  ],
  ["nothing", "空欄"],
  ["an empty file", "空のファイル"],
  ["{#n}, but {#found} posture below", "{#n} とあるが、下の姿勢は {#found} 個"],
  ["{#n}, but {#found} postures below", "{#n} とあるが、下の姿勢は {#found} 個"],
  ["{#n}, but {#found} key below", "{#n} とあるが、下のキーは {#found} 個"],
  ["{#n}, but {#found} keys below", "{#n} とあるが、下のキーは {#found} 個"],
  ["{#n}, but {#found} row of angles below", "{#n} とあるが、下の角度は {#found} 行"],
  ["{#n}, but {#found} rows of angles below", "{#n} とあるが、下の角度は {#found} 行"],
  ["{cell} again (first in row {#n})", "{cell} が重複（最初は {#n} 行目）"],
  ["{#n} cell", "{#n} 個のセル"],
  ["{#n} cells", "{#n} 個のセル"],
  ["{#n} angle", "{#n} 個の角度"],
  ["{#n} angles", "{#n} 個の角度"],
  [
    "{#n} angles a row: a gait for a robot with {#legs} legs",
    "1 行に {#n} 個の角度（{#legs} 脚用の歩容）",
  ],
  ["more than {#n} bytes", "{#n} バイト超"],
  ["{#n} bytes", "{#n} バイト"],
  [
    "bytes that are no text (byte {#n} is {byte})",
    "テキストではないデータ（{#n} バイト目が {byte}）",
  ],
  ["bytes that are no text", "テキストではないデータ"],
  ["a workbook that can't be read", "読み込めないブック"],
  ["sequences of postures", "姿勢の並び"],
  ["an old .xls workbook, or one with a password", "古い .xls 形式、またはパスワード付きのブック"],
  ["a zip that is no workbook", "ブックではない zip ファイル"],
  ["a workbook of more than {#n} elements", "要素が {#n} 個を超えるブック"],
  ["a workbook that defines XML entities", "XML の実体を定義しているブック"],
  ["a damaged file, or no workbook", "壊れたファイル、またはブックではないファイル"],
  ["a workbook that unpacks to more than 8 MiB", "展開すると 8 MiB を超えるブック"],
  ["a file with a password", "パスワード付きのファイル"],
  ["the sheets {sheets}", "シート {sheets}"],
  ["uncalculated {formula}", "計算されていない式 {formula}"],
  ["the other kind of table", "もう一方の種類の表"],
  ["none for this arena", "この競技で使えるものがない"],
];

/** Mistakes in robot files (robots/lacoc_robots/toml_entries.py, robot_file.py). */
const ROBOTS: readonly Pattern[] = [
  ["{#n} numbers in [ ]", "[ ] の中に {#n} 個の数"],
  [
    'a number from {#low} to {#high} {unit} with advance = "time"',
    '{#low} から {#high} {unit} までの数（advance = "time" のとき）',
  ],
  ["a number from {#low} to {#high} degrees/s", "{#low} から {#high} 度/秒までの数"],
  ["a number from {#low} to {#high} degrees", "{#low} から {#high} 度までの数"],
  ["a number from {#low} to {#high} {unit}", "{#low} から {#high} {unit} までの数"],
  ["a number from {#low} to {#high}", "{#low} から {#high} までの数"],
  ["a number of very many digits", "桁数が多すぎる数"],
  ["a number", "数"],
  ["a text of 1 to {#n} characters", "1～{#n} 文字のテキスト"],
  ["true or false", "true または false"],
  ["a table that begins with the line {line}", "{line} の行で始まる表"],
  [
    "an even number of legs from {#low} to {#high}, each begun by the line [[leg]]",
    "{#low}～{#high} 本の偶数の脚（それぞれ [[leg]] の行で始める）",
  ],
  ["one of {names}", "次のいずれか：{names}"],
  ["another label for every leg", "脚ごとに異なるラベル"],
  [
    "a leg that points to the right (near 0) or to the left (near 180)",
    "右向き（0 付近）または左向き（180 付近）の脚",
  ],
  ["the smaller angle first", "小さい角度を先に"],
  [
    "a root link at least its radius long, and the others longer than two radii (radius_m is {#n})",
    "Root リンクは半径以上、ほかは半径の 2 倍より長く（radius_m は {#n}）",
  ],
  [
    "the legs clockwise, seen from above, beginning at the right front",
    "上から見て右前から時計回りの脚の順番",
  ],
  ["a robot of {#low} to {#high} kg", "{#low}～{#high} kg のロボット"],
  ["at most {#n} m, with legs and their radius", "脚とその半径を含めて {#n} m 以下"],
  ["{#low} to {#high} m for this start posture", "この開始姿勢では {#low}～{#high} m"],
  ["at most {#n}", "{#n} 以下"],
  ["a TOML file saved as UTF-8", "UTF-8 で保存した TOML ファイル"],
  [
    "TOML of at most {#n} bytes: lines such as  name = value",
    "{#n} バイト以下の TOML（「名前 = 値」の形の行）",
  ],
  ["TOML: lines such as  name = value", "TOML（「名前 = 値」の形の行）"],
  ["{#n} entries", "{#n} 個の値"],
  ["a table", "表"],
  ["an unknown entry", "不明な項目"],
  ["{#n} of them", "{#n} 個"],
  ["{label} for a second time", "{label} が 2 回目"],
  ["{#n} degrees, straight forward or back", "{#n} 度（真正面または真後ろ）"],
  ["{level} link {#n} m long", "{level} リンクの長さ {#n} m"],
  ["{one} not clockwise of {other}", "{one} が {other} の時計回り側にない"],
  ["{#n} kg together", "合計 {#n} kg"],
  ["a robot {#n} m wide with every angle 0", "全角度 0 で幅 {#n} m のロボット"],
  ["a robot {#n} m long with every angle 0", "全角度 0 で長さ {#n} m のロボット"],
  ["a robot {#n} m high with every angle 0", "全角度 0 で高さ {#n} m のロボット"],
  [
    "{#n}, with the lowest part {#above} m above the floor",
    "{#n}（最も低い部分が床から {#above} m）",
  ],
  ["brackets in brackets, too deep", "括弧の入れ子が深すぎる"],
  ["{#low} to {#high}", "{#low}～{#high}"],
  ['"{one}" or "{other}"', "「{one}」または「{other}」"],
];

/** What the gateway and the page themselves say no to (client/lacoc_client/gateway). */
const GATEWAY: readonly Pattern[] = [
  [
    "The gateway has a fault; its window says more. Try again, or tell the organiser.",
    "サーバーで異常が起きました（詳しくはサーバーの画面に表示されます）。もう一度試すか、主催者に知らせてください。",
  ],
  ["not connected", "接続されていません。"],
  ["the connection broke", "接続が切れました。"],
  ["Enter with the referee's token first.", "先に審判用トークンで入室してください。"],
  ["Nobody acts as referee now: take over first.", "審判がいません。先に交代してください。"],
  [
    "{name} acts as referee now: take over first.",
    "{name} が審判を担当中です。先に交代してください。",
  ],
  [
    "There is no court {court} here; there is {courts}.",
    "ここにコート {court} はありません（{courts} があります）。",
  ],
  [
    "Court {court} speaks {Version} of the protocol, this gateway version {#n}: install the version of lacoc that the court has.",
    "コート {court} の通信方式は{Version}、このサーバーは第 {#n} 版です。コートと同じ版の lacoc を入れてください。",
  ],
  ["version {#n}", "第 {#n} 版"],
  ["another version", "別の版"],
  ["Court {court} is not there yet.", "コート {court} はまだありません。"],
  ["This was not understood: {error}.", "要求を読み取れませんでした：{error}"],
  ["{#n} bytes, at most {#most} are read", "{#n} バイト（上限 {#most} バイト）"],
  ["Say first which court to watch.", "先にコートを指定してください。"],
  ["Say who you are: it stands in the record.", "お名前を入力してください（記録に残ります）。"],
  [
    "This page may only watch: open the address with its key, as the one who started the gateway has it.",
    "このページは閲覧専用です。サーバーを起動した人から、鍵の付いたアドレスを受け取って開いてください。",
  ],
  ["Too many tries: wait a few seconds.", "試行回数が多すぎます。数秒お待ちください。"],
  ["Too much at once: wait for the answers.", "要求が多すぎます。応答をお待ちください。"],
  [
    "The token is missing: the organiser has it.",
    "トークンがありません。主催者から受け取ってください。",
  ],
  [
    "This page holds no seat: join one first.",
    "このページは席に着いていません。先に参加してください。",
  ],
  [
    "This gateway shows the match to {#n} pages already: try again later, or watch the stream if there is one.",
    "すでに {#n} ページが接続しています。後でもう一度試すか、配信をご覧ください。",
  ],
  [
    "{#n} pages with the key are open here already: close those nobody needs.",
    "鍵の付いたページがすでに {#n} 個開いています。不要なページを閉じてください。",
  ],
  ["no answer", "応答なし"],
  ["Team {Seat}", "チーム {Seat}"],
  [
    "Nobody listens at {address}. Is the court running, and is this its port?",
    "{address} では何も応答しません。コートが起動しているか、ポートが正しいか確かめてください。",
  ],
  [
    "The name in {address} is not known on this network.",
    "{address} の名前がこのネットワークで見つかりません。",
  ],
  [
    "{address} can't be reached ({Why}). Check the address, the network and firewalls.",
    "{address} に接続できません（{Why}）。アドレス、ネットワーク、ファイアウォールを確かめてください。",
  ],
  [
    "Something answers at {address}, but it does not let this program in. Is it a court, and of the same version?",
    "{address} は応答しますが接続できません。コートかどうか、同じ版かどうかを確かめてください。",
  ],
  [
    "The name {name} is not known on this network. Check its spelling, or use the number (such as 192.168.1.5) instead.",
    "{name} という名前がこのネットワークで見つかりません。つづりを確かめるか、番号（192.168.1.5 など）を使ってください。",
  ],
  [
    "The court at {address} is the right one, but it does not take this token. Ask the organiser for the invitation that is valid now; a court that is full or of another version refuses in the same way.",
    "{address} は正しいコートですが、このトークンを受け付けません。現在有効な招待を主催者から受け取ってください（満員のコートや版の異なるコートも同じように拒否します）。",
  ],
  [
    "The court at {address} has keys: enter with the invitation that the organiser has for you (--invitation FILE), or with the contest file.",
    "{address} のコートには鍵が必要です。主催者から受け取った招待（--invitation FILE）か、大会ファイルを使ってください。",
  ],
  [
    "What answers at {address} has no keys, and your invitation is for a court that has. Is it the right port, and was the court started with its contest file?",
    "{address} で応答するものには鍵がありませんが、招待は鍵のあるコートのものです。ポートが正しいか、コートが大会ファイルを使って起動されたか確かめてください。",
  ],
  [
    "What answers at {address} can't prove that it is the court of your invitation ({reason}). Do not go on; ask the organiser whether the address is right and the invitation the newest.",
    "{address} で応答するものが招待のコートだと確認できません（{reason}）。接続をやめ、アドレスが正しいか、招待が最新か、主催者に確かめてください。",
  ],
  [
    "The certificate of the court at {address} is not made for the name {host}. Use the name in your invitation; an organiser adds one with 'lacoc contest keys --host {same}'.",
    "{address} のコートの証明書は {host} という名前のものではありません。招待にある名前を使ってください（主催者は「lacoc contest keys --host {same}」で追加できます）。",
  ],
  [
    "The certificate of the court at {address} is not valid yet: is this machine's clock right?",
    "{address} のコートの証明書はまだ有効期間前です。このパソコンの時計が正しいか確かめてください。",
  ],
  [
    "The certificate of the court at {address} has expired, or this machine's clock is wrong. An organiser makes new keys with 'lacoc contest keys --renew'.",
    "{address} のコートの証明書は期限切れか、このパソコンの時計が違っています（主催者は「lacoc contest keys --renew」で鍵を作り直せます）。",
  ],
  [
    "The certificate in the invitation is damaged: ask the organiser for it again.",
    "招待の証明書が壊れています。主催者から受け取り直してください。",
  ],
];

/** How lists are split, and put together again. */
const LISTS: Record<string, readonly [RegExp, string]> = {
  Phases: [/ or /, "・"],
  Reasons: [/; /, "。"],
};

const DECISION_NAMES = WORDS.slice(WORDS.findIndex(([english]) => english === "ready"));

const PATTERNS: readonly Pattern[] = [
  ...FRAMES,
  // The court names the decision that it refuses first.
  ...DECISION_NAMES.map(([name, word]) => [`${name}: {Sentence}`, `${word}：{Sentence}`] as const),
  ...EVENTS,
  ...HEALTH,
  ...DECISIONS,
  ...DISK,
  ...CONTESTANTS,
  ...GATEWAY,
  ...COUNTED,
  ...GAITS,
  ...ROBOTS,
];

const HOLE = /\{(#?)(\w+)\}/g;
const NUMBER = "[-+]?(?:\\d[\\d.,]*(?:e[-+]?\\d+)?|nan|inf)";

/** What ends so may have its full stop in the hole; elsewhere the stop is not part of a name. */
const TAKES_STOP = /(\.|\{Sentence\}|\{Reason\})$/;

/** Sentences without holes are found at once; the others are tried in their order. */
const WHOLE = new Map([...WORDS, ...PATTERNS.filter(([english]) => !english.includes("{"))]);
const WITH_HOLES = PATTERNS.filter(([english]) => english.includes("{")).map(
  ([english, japanese]) => [compile(english), japanese] as const,
);

function compile(english: string): RegExp {
  const plain = english.replace(/[.*+?^$()|[\]\\]/g, "\\$&");
  const source = plain.replace(HOLE, (_, number, name) => `(?<${name}>${number ? NUMBER : ".+?"})`);
  return new RegExp(`^${source}${TAKES_STOP.test(english) ? "" : "(?<!\\.)"}$`, "s");
}

/** What was said before: pages draw their logs again and again. */
const SAID = new Map<string, string>();
const SAID_MOST = 2000;

/** A sentence in Japanese; as it is where none of the patterns fits. */
export function toJapanese(text: string): string {
  const known = SAID.get(text);
  if (known !== undefined) return known;
  const japanese = found(text) ?? withoutStop(text) ?? text;
  if (SAID.size >= SAID_MOST) SAID.clear();
  SAID.set(text, japanese);
  return japanese;
}

function found(text: string): string | null {
  const whole = WHOLE.get(text);
  if (whole !== undefined) return whole;
  for (const [pattern, japanese] of WITH_HOLES) {
    const holes = pattern.exec(text)?.groups;
    if (holes) return japanese.replace(HOLE, (_, __, name) => filled(name, holes[name] ?? ""));
  }
  return null;
}

function filled(name: string, text: string): string {
  const list = LISTS[name];
  if (list) return text.split(list[0]).map(toJapanese).join(list[1]);
  return /^[A-Z]/.test(name) ? toJapanese(text) : text;
}

/** The same reason stands alone, and as a sentence with its full stop. */
function withoutStop(text: string): string | null {
  if (!text.endsWith(".")) return null;
  const japanese = found(text.slice(0, -1));
  return japanese && `${japanese}。`;
}
