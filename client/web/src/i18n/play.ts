/** Messages of /play and /practice: English, Japanese. */
export const play = {
  // The card
  "join.title": ["Join a match", "試合に参加"],
  "join.practice": ["Practice", "練習"],
  "join.court": ["Court", "コート"],
  "join.free": ["free", "空き"],
  "join.takenBy": ["{team} sits here", "{team} が参加中"],
  "join.name": ["Team name", "チーム名"],
  "join.nameHint": ["1 to {most} characters", "1～{most} 文字"],
  "join.nameMissing": [
    "Give your team a name of 1 to {most} characters.",
    "チーム名を 1～{most} 文字で入力してください。",
  ],
  "join.go": ["Join", "参加する"],
  "join.going": ["Joining …", "参加しています…"],
  "join.again": ["Join again", "もう一度参加する"],
  "join.safety": [
    "On the venue's pages only its token protects a seat. 'lacoc play' on your own computer is safer.",
    "会場のページでは、席を守るのはトークンだけです。自分のパソコンの「lacoc play」の方が安全です。",
  ],
  "join.waits": [
    "You get your seat as soon as the court answers.",
    "コートが応答しだい、席に着きます。",
  ],
  "join.refused": ["You could not join", "参加できませんでした"],
  "watching.title": ["With this link you can only watch", "このリンクでは観戦だけできます"],
  "watching.text": [
    "To play here, open the address that ends with #key=…. 'lacoc play' printed it when it started.",
    "ここで参加するには、末尾に #key=… が付いたアドレスを開いてください。「lacoc play」を起動した画面に表示されています。",
  ],
  "watching.practice": [
    "To practise, start 'lacoc practice'. It opens this page with its key.",
    "練習するには「lacoc practice」を起動してください。鍵の付いたこのページが開きます。",
  ],
  "watching.watch": ["Watch the match", "試合を観戦する"],
  "lost.title": ["You have lost your seat", "席を失いました"],
  "left.title": ["You have left", "退出しました"],
  "left.text": [
    "Your robot stands. You can come back with the same token.",
    "ロボットは停止しています。同じトークンで戻れます。",
  ],
  "left.practice": ["Your practice has ended.", "練習を終了しました。"],
  "left.practiceAgain": ["Practise again", "もう一度練習する"],

  // A team in a contest with an office
  "team.title": ["Play", "参加する"],
  "team.text": [
    "Open your link, or type its token here. This page then finds your seat by itself.",
    "リンクを開くか、そのトークンをここに入力してください。席はこのページが自動で見つけます。",
  ],
  "team.token": ["Your token", "トークン"],
  "team.go": ["Go on", "進む"],
  "team.asking": ["Asking where you play …", "試合のコートを確認しています…"],
  "team.next": ["Your next match", "次の試合"],
  "team.before": ["Games before yours: {count}", "この試合の前のゲーム：{count}"],
  "team.byItself": [
    "Keep this page open: it goes to your court by itself.",
    "このページを開いたままにしてください。時間になると自動でコートに移ります。",
  ],
  "team.driven": [
    "{team} is driven in another window or on another device.",
    "{team} は別の画面か別の端末で操縦されています。",
  ],
  "team.takeOver": ["Take over", "操縦を引き継ぐ"],
  "team.thanks": ["Thank you for playing", "お疲れさまでした"],
  "team.other": ["Another token", "別のトークン"],

  // Files
  "files.title": ["Your files", "ファイル"],
  "files.drop": [
    "Drop your robot and gait files here, or",
    "ロボットファイルと歩容ファイルをここにドロップするか、",
  ],
  "files.pick": ["choose files", "ファイルを選ぶ"],
  "files.robot": ["Robot", "ロボット"],
  "files.postures": ["Level A: postures", "レベル A：姿勢"],
  "files.locomotion": ["Level B: locomotion", "レベル B：移動動作"],
  "files.contests": ["the contest's", "大会標準"],
  "files.sample": ["the sample", "見本"],
  "files.none": ["none", "なし"],
  "files.given": ["(from this computer's folder)", "（このパソコンのフォルダーから）"],
  "files.made": ["made from {name}", "{name} から作成"],
  "files.sequences": ["Keys of level B", "レベル B のキー"],
  "files.sequencesHint": [
    "Each key runs through these postures, one after another. Key 1 is also ←, 2 is ↑, 3 is →.",
    "各キーで順に取る姿勢の番号です。1 は ←、2 は ↑、3 は → でも操作できます。",
  ],
  "files.sequence": ["Postures of key {digit}", "キー {digit} の姿勢"],
  "files.newKey": ["another key", "キーを追加"],
  "files.sampleSequences": ["Back to the sample", "見本に戻す"],
  "files.changed": ["On your disk, {names} has changed.", "{names} が変更されました。"],
  "files.changedWrong": [
    "On your disk, {names} has changed and can't be used.",
    "{names} が変更されましたが、このままでは使えません。",
  ],
  "files.mistakes": ["Mistakes in {names}: {count}", "{names} の誤り：{count} か所"],
  "files.useNew": ["Use it now", "今すぐ使う"],
  "files.beginsAnew": [
    "Practice then starts again: place, clock, distance and Pos-data.txt begin at zero.",
    "使うと練習は最初から（位置・時計・距離・Pos-data.txt）やり直しになります。",
  ],
  "files.remove": ["Remove {name}", "{name} を外す"],
  "files.tooLarge": [
    "{name} is too large for a gait or a robot.",
    "{name} は歩容やロボットのファイルとしては大きすぎます。",
  ],
  "files.unreadable": [
    "{name} can't be read. If it is a folder, drop the files in it instead.",
    "{name} を読み込めません。フォルダーではなく、中のファイルをドロップしてください。",
  ],
  "files.notNow": ["Choose files before a match.", "ファイルは試合の前に選びます。"],
  "files.change": ["Change files", "ファイルを変更"],
  "files.use": ["Use these files", "このファイルを使う"],
  "files.changeText": [
    "After you change files, say ready again. A match in progress keeps the files that it began with.",
    "ファイルを変えると、準備完了をもう一度押す必要があります。進行中の試合は、開始時のファイルのまま続きます。",
  ],
  "files.noKey": [
    "No key will move your robot. Add a {file} file.",
    "どのキーでもロボットは動きません。{file} ファイルを用意してください。",
  ],

  // What to do next
  "next.wait": ["The court is opening …", "コートを準備しています…"],
  "next.ready": ["Press Ready when you are ready", "準備ができたら「準備完了」を押してください"],
  "next.joining": [
    "You are ready. Waiting for the {seat} seat",
    "準備完了です。{seat}の席の参加を待っています",
  ],
  "next.notReady": [
    "You are ready. Waiting for {team}",
    "準備完了です。{team} の準備を待っています",
  ],
  "next.start": [
    "Both are ready. The referee starts the match",
    "両チームの準備が完了しました。審判の開始を待っています",
  ],
  "next.countdown": ["Fingers on the keys!", "キーに指を置いてください！"],
  "next.locked": [
    "Restarted: your keys work again in {seconds} s",
    "再スタート：あと {seconds} 秒でキーが使えます",
  ],
  "next.frozen": ["Frozen by the referee for {seconds} s", "審判により停止中：あと {seconds} 秒"],
  "next.silent": [
    "The court lost contact with you: press a key to move again",
    "通信が途切れたため停止中。キーを押すと動きます",
  ],
  "next.halted": [
    "Halted. Please wait until the referee resumes the match",
    "中断中です。審判が再開するまで、そのままお待ちください",
  ],
  "next.finished": [
    "The match is over. The referee is confirming the result",
    "試合終了。審判が結果を確認しています",
  ],
  "next.official": [
    "Wait here: you play in the next match too",
    "このままお待ちください。次の試合にも参加します",
  ],
  "next.practice": ["Practice is starting …", "練習を始めます…"],
  "next.lost": [
    "No connection to the court: your robot stands until it is back",
    "コートとつながっていません。つながるまでロボットは停止します",
  ],
  "next.rejoin": ["Taking your seat again …", "席に戻っています…"],

  // Before the match
  "brief.label": ["Your match", "この試合"],
  "brief.own": ["Your robot stands on the {seat}", "あなたのロボットは{seat}側です"],
  "brief.rule": ["How you score", "得点のしかた"],
  "brief.keys": ["How you steer", "動かし方"],
  "brief.once": [
    "Press a key once: the robot goes on until you press another. 0 stops it, x puts it back at its start.",
    "キーを 1 回押すと、次のキーまで動き続けます。0 で停止、x でスタート位置に戻ります。",
  ],
  "brief.postures": [
    "At level A each key is one posture: press several, one after another, to walk.",
    "レベル A ではキーごとに 1 つの姿勢です。続けて押すと歩きます。",
  ],
  "tag.own": ["You", "あなた"],

  // Ready
  "ready.say": ["Ready", "準備完了"],
  "ready.said": ["You are ready", "準備完了です"],
  "ready.takeBack": ["Take back", "取り消す"],

  // The pad
  "pad.title": ["Keys", "キー"],
  "pad.level": ["Level of control", "操作レベル"],
  "pad.levelA": ["A posture", "A 姿勢"],
  "pad.levelB": ["B locomotion", "B 移動動作"],
  "pad.onlyA": ["Each key is one posture", "キーごとに 1 つの姿勢"],
  "pad.onlyB": ["A key goes on until the next one", "次のキーを押すまで続きます"],
  "pad.tab": [
    "Tab changes the level (the robot does not move)",
    "Tab でレベルを切り替え（それだけでは動きません）",
  ],
  "pad.posture": ["posture", "姿勢"],
  "pad.one": ["1 posture", "1 姿勢"],
  "pad.many": ["{count} postures", "{count} 姿勢"],
  "pad.nothing": ["nothing", "なし"],
  "pad.key": ["Key {digit}: {what}", "キー {digit}：{what}"],
  "pad.stands": [
    "{level} {key}: posture {posture} of {count}",
    "{level} {key}：姿勢 {posture}／{count}",
  ],
  "pad.standsOne": ["{level} {key}: posture is held", "{level} {key}：姿勢を保持"],
  "pad.none": ["No key yet", "まだキーは押されていません"],
  "pad.restart": ["To the start", "スタートへ"],
  "pad.restartIn": ["in {seconds} s", "あと {seconds} 秒"],
  "pad.view": ["View", "視点"],
  "pad.leave": ["Leave", "退出"],

  // Views
  "views.badge": ["View {number}/3", "視点 {number}/3"],
  "views.arena": ["arena", "全体"],
  "views.top": ["from above", "真上"],
  "views.chase": ["behind the robot", "ロボットの後ろ"],
  "views.label": ["The field in 3D", "フィールドの 3D 表示"],
  "field.label": [
    "Field. Digits steer, Space changes the view, x restarts, z leaves (hold it in a match). ? lists all keys. Tab or Escape leave the field.",
    "フィールド。数字で操作、スペースで視点、x で再スタート、z で退出（試合中は長押し）。? でキー一覧。Tab か Esc でフィールドの外へ。",
  ],
  "field.labelLevels": [
    "Field. Digits steer, Tab changes the level, Space changes the view, x restarts, z leaves (hold it in a match). ? lists all keys. Escape leaves the field.",
    "フィールド。数字で操作、Tab でレベル、スペースで視点、x で再スタート、z で退出（試合中は長押し）。? でキー一覧。Esc でフィールドの外へ。",
  ],
  "field.outByTab": ["Tab: to the buttons", "Tab：ボタンへ"],
  "field.outByEscape": ["Esc: to the buttons", "Esc：ボタンへ"],

  // For screen readers
  "heard.label": ["The match in words", "試合の経過"],
  "heard.score": [
    "{left} {leftPoints}, {right} {rightPoints}",
    "{left} {leftPoints} 点、{right} {rightPoints} 点",
  ],
  "heard.left": ["{seconds} seconds left", "残り {seconds} 秒"],

  // All keys
  "keys.digits": ["steer: what each digit does stands on its key", "操作（動きは各キーに表示）"],
  "keys.arrows": ["the same as 0, 1, 2, 3", "0、1、2、3 と同じ"],
  "keys.arrowsB": ["the same as 0, 1, 2, 3 of level B", "レベル B の 0、1、2、3 と同じ"],
  "keys.level": ["change the level of control", "操作レベルを切り替える"],
  "keys.restart": ["put the robot back at its start", "ロボットをスタート位置に戻す"],
  "keys.view": ["change the view", "視点を切り替える"],
  "keys.ready": ["say ready", "準備完了にする"],
  "keys.leave": ["leave; in a match hold it", "退出（試合中は長押し）"],
  "keys.leavePractice": ["end practice", "練習を終了する"],
  "keys.out": ["from the field to the buttons", "フィールドからボタンへ移る"],

  // Leave
  "leaving.hold": ["Hold z to leave the match", "退出するには z を長押し"],
  "leaving.go": ["Leave now", "今すぐ退出"],
  "leaving.stay": ["Stay", "続ける"],
  "leave.title": ["Leave?", "退出しますか？"],
  "leave.match": [
    "Your robot will stand. The seat stays yours, and you can come back.",
    "ロボットは停止します。席はそのまま残り、戻ることができます。",
  ],
  "leave.lobby": ["Your seat becomes free.", "席が空きます。"],
  "leave.practice": ["Your practice ends.", "練習を終了します。"],
  "leave.data": [
    "Pos-data.txt, the path of your robot, is saved.",
    "ロボットの軌跡 Pos-data.txt を保存します。",
  ],
  "leave.dataSince": [
    "Pos-data.txt, the path of your robot, is saved from {time} on, when this page was loaded.",
    "Pos-data.txt には、このページを読み込んだ {time} 以降の軌跡を保存します。",
  ],
  "leave.dataRecord": [
    "The record of the match has the whole path.",
    "試合の記録には最初からすべて残っています。",
  ],
  "leave.dataNewest": [
    "Pos-data.txt, the path of your robot, is saved from {time} on, because this page keeps only the last hour.",
    "Pos-data.txt には {time} 以降の軌跡を保存します（このページに残るのは最新の 1 時間です）。",
  ],
  "leave.noData": [
    "There is no Pos-data.txt: this page has not seen your robot on the field.",
    "Pos-data.txt はありません（このページはまだフィールド上のロボットを記録していません）。",
  ],
  "leave.go": ["Save and leave", "保存して退出"],
  "leave.goNoData": ["Leave", "退出"],
  "leave.save": ["Only save", "保存のみ"],
  "leave.saved": [
    "Pos-data.txt saved: the path of your robot",
    "Pos-data.txt を保存しました（ロボットの軌跡）",
  ],

  // Toasts
  "toast.refused": ["[{key}] {why}", "[{key}] {why}"],
  "toast.arrows": [
    "Arrows are for level B; Tab changes the level",
    "矢印キーはレベル B 用です。Tab で切り替えます",
  ],
  "toast.level": ["Level {level}: press a digit", "レベル {level}：数字を押してください"],

  // Over the field
  "focus.steer": ["Click here to steer", "クリックして操作を続ける"],
  "focus.why": ["Another window has the keyboard", "キーボード入力が別のウィンドウに向いています"],
  "ime.on": [
    "A Japanese input method is on. Keys still steer. If a key does not work, turn it off (半角/全角).",
    "日本語入力がオンです。キー操作はできますが、効かないときは「半角/全角」でオフにしてください。",
  ],
  "end.save": ["Save Pos-data.txt", "Pos-data.txt を保存"],

  // Footer
  "foot.trip": ["Key to picture", "キーの反映"],
  "foot.tripHint": [
    "From your newest key to the picture that shows it",
    "キーを押してから画面に反映されるまで",
  ],
  "foot.link": ["Link", "通信"],
  "foot.linkHint": [
    "Measured by the court: from sending a frame until it hears that this page shows it",
    "コートが測った、コマを送ってから、この画面に映ったと分かるまでの時間",
  ],
  "foot.equal": ["equal for both: {count} ms", "両者同じ：{count} ms"],
  "foot.equalHint": [
    "Time from a picture until a key pressed in response takes effect, the same for both of you",
    "画面を見て押したキーが効くまでの時間（両者同じ）",
  ],
  "foot.frames": ["Frames", "フレーム"],
  "foot.perSecond": ["{count}/s", "{count}/秒"],
  "foot.ms": ["{count} ms", "{count} ms"],
  "foot.linked": ["connected", "接続中"],
  "foot.broken": ["no link", "切断"],
  "foot.settings": ["Settings", "設定"],

  // The test of the link
  "linktest.test": ["Test my connection", "通信をテスト"],
  "linktest.title": ["Test of your connection", "通信のテスト"],
  "linktest.text": [
    "It measures for 10 seconds the whole way from this page to the court and back.",
    "この画面からコートまでの往復を 10 秒間測ります。",
  ],
  "linktest.runs": ["Measuring …", "測定しています…"],
  "linktest.again": ["Test again", "もう一度テスト"],
  "linktest.p50": ["Round trip, median", "往復時間（中央値）"],
  "linktest.p95": ["95 % are faster than", "95 % がこれより速い"],
  "linktest.frames": ["Frames", "フレーム"],
  "linktest.missed": [
    "{frames}: {lost} lost, {late} late",
    "{frames} 枚（欠落 {lost}、遅れ {late}）",
  ],
  "linktest.noFrames": ["No court sends any now.", "今はどのコートからも届いていません"],
  "linktest.noAnswer": ["no answer", "応答なし"],
  "linktest.good": [
    "Good: you can play any match over this connection.",
    "良好です。この通信なら、どの試合でも問題なく戦えます。",
  ],
  "linktest.equal": [
    "Playable if the court gives both teams the same delay: ask the organiser whether it does.",
    "両チームの遅れをそろえるコートなら戦えます。そろえる設定かどうか、主催者に確かめてください。",
  ],
  "linktest.slow": [
    "Too slow for a fair match: use a cable or go closer to the Wi-Fi, close other programs and videos, and test again; if that does not help, tell the organiser.",
    "公平な試合をするには遅すぎます。有線にするか Wi-Fi の近くに移り、ほかのプログラムや動画を閉じて、もう一度テストしてください。それでも変わらなければ、主催者に知らせてください。",
  ],

  "keytest.title": ["Key test", "キーのテスト"],
  "keytest.hint": [
    "Click here and press keys. Nothing is sent.",
    "ここをクリックしてキーを押してください（送信されません）。",
  ],
  "keytest.digit": ["digit {digit}", "数字 {digit}"],
  "keytest.arrow": ["{digit} of level B", "レベル B の {digit}"],
  "keytest.restart": ["restart", "再スタート"],
  "keytest.ready": ["ready", "準備完了"],
  "keytest.leave": ["leave", "退出"],
  "keytest.level": ["level", "レベル切替"],
  "keytest.view": ["view", "視点切替"],
  "keytest.none": ["does nothing", "割り当てなし"],
  "keytest.ime": ["through an input method", "日本語入力を経由"],

  // Practice
  "coach.title": ["First steps", "はじめの一歩"],
  "coach.forward": [
    "Slowly press 1, 2, 3, 4, one after another. The robot walks.",
    "1、2、3、4 をゆっくり順番に押してみよう。ロボットが歩きます。",
  ],
  "coach.again": ["Well done. Go on: 1, 2, 3, 4 …", "いいね。続けて 1、2、3、4…"],
  "coach.back": ["Press 4, 3, 2, 1 to walk back.", "4、3、2、1 で後ろへ歩きます。"],
  "coach.turn": ["Press 5, 6, 7, 8 to turn right.", "5、6、7、8 で右へ回ります。"],
  "coach.level": [
    "Now press Tab for level B, then 2. One key is enough to keep walking.",
    "次は Tab でレベル B に切り替えて 2。キー 1 つで歩き続けます。",
  ],
  "coach.free": [
    "Walk anywhere. x puts the robot back at its start, z saves its path.",
    "自由に歩かせよう。x でスタート位置へ戻り、z で軌跡を保存します。",
  ],
  "coach.own": [
    "The gait of your files is loaded. Press its keys and see where the robot goes.",
    "ファイルの歩容を読み込みました。キーを押して動きを確かめよう。",
  ],
  "coach.pressed": ["Pressed", "押したキー"],
  "coach.skip": ["Skip", "とばす"],
  "coach.repeat": ["Start again", "最初から"],
  "walk.heading": ["Heading", "向き"],
  "walk.walked": ["Walked", "歩行距離"],
  "walk.speed": ["Speed", "速さ"],
} as const satisfies Record<string, readonly [string, string]>;
