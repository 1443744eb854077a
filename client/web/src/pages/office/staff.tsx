/** The links that helpers have: those of the courts' referees, and of the staff. */

import { useSignal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { useEffect } from "preact/hooks";
import { type OfficeView, TEAM_NAME_MAX } from "../../core/desk";
import { pictureUrl } from "../../core/picture";
import { t } from "../../i18n";
import { Dialog } from "../../ui/dialog";
import { CopyButton } from "./dialogs";
import type { Organiser } from "./organiser";

interface Props {
  organiser: Organiser;
  view: OfficeView;
}

/** The links of the courts' referees, and of the staff: to this page, under a name of their own. */
export function StaffDialog({ organiser, view }: Props) {
  const name = useSignal("");
  const names = view.staff.join("\n");
  useEffect(() => void organiser.getLinks(), [organiser, names]);
  const { staff: links = [], referees = [] } = organiser.links.value ?? {};
  return (
    <Dialog title={t("office.day.staff")} onClose={() => organiser.close()}>
      <div class="asks">
        <p>{t("office.staff.text")}</p>
        <form
          class="asks"
          onSubmit={async (event) => {
            event.preventDefault();
            if (await organiser.do({ do: "staff", name: name.value })) name.value = "";
          }}
        >
          <label class="field">
            <span>{t("office.staff.name")}</span>
            <input
              value={name.value}
              maxLength={TEAM_NAME_MAX}
              required
              onInput={(event) => {
                name.value = event.currentTarget.value;
              }}
            />
          </label>
          <button class="button strong" type="submit">
            {t("office.staff.add")}
          </button>
        </form>
        <ul class="staff">
          {links.map((one) => (
            <li key={one.name}>
              <QrLink title={one.name} link={one.link} qr={one.qr}>
                <button
                  class="button quiet small"
                  type="button"
                  onClick={() => void organiser.do({ do: "staff", name: one.name, remove: true })}
                >
                  {t("office.staff.remove", { name: one.name })}
                </button>
              </QrLink>
            </li>
          ))}
        </ul>
        <h3>{t("office.staff.referees")}</h3>
        <p>{t("office.refereeLink")}</p>
        <ul class="referees">
          {referees.map(({ court, link, qr }) => (
            <li key={court}>
              <QrLink title={t("office.refereeOf", { court })} link={link} qr={qr} />
            </li>
          ))}
        </ul>
      </div>
    </Dialog>
  );
}

interface QrLinkProps {
  title: string;
  link: string;
  /** The link as a QR code. */
  qr: string;
  children?: ComponentChildren;
}

/** A link of somebody, to scan or to copy. */
function QrLink({ title, link, qr, children }: QrLinkProps) {
  return (
    <div class="qr">
      <img src={pictureUrl(qr)} alt={t("office.qrOf", { team: title })} />
      <div>
        <b>{title}</b>
        <a href={link}>{link}</a>
        <CopyButton link={link} />
        {children}
      </div>
    </div>
  );
}
