/** How much of an eye's picture the target has been in: fields fill up as corners are seen there. */

const COVERED = 4;

export function CoverMap({ eye, fields }: { eye: string; fields: readonly (readonly number[])[] }) {
  const all = fields.flat();
  const covered = all.filter((count) => count >= COVERED).length;
  const share = all.length === 0 ? 0 : Math.round((100 * covered) / all.length);
  return (
    <figure className="cover">
      <div className="cover-fields" role="img" aria-label={`${share} % of the ${eye} picture covered`}>
        {all.map((count, k) => (
          <span key={k} data-covered={count >= COVERED} />
        ))}
      </div>
      <figcaption>
        {eye} picture, <span className="number">{share}</span> % covered
      </figcaption>
    </figure>
  );
}
