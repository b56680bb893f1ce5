# The keyboard alone. Keys by their X names: Prior and Next are Page up and Page down.
shot start
for control in person new-person skip-first-steps first-steps tasks patients open-folder help needle forces breathing add-device needle-device probe-device open-first-steps start; do
  key Tab
  [[ $control != help ]] || key Down Up  # assisted, and back to guided
  shot "start-$control"
done
key space
seen 1-briefing
shot briefing
key Tab
shot briefing-next
key shift+Tab
key space
seen 2-ready
shot ready
key h # the transducer to its planned position
seen 2-found
key a h # the needle
seen 2-aimed

# Through the controls of the scanner: a choice keeps its own arrows, and A brings the needle back.
key k
for n in 1 2 3 4; do key Tab; shot "controls-$n"; done
key a
shot needle-again
key k
until_seen 3-inside key Prior Prior
key space
seen 4-stopped
shot stopped
key space
seen 5-on-again
until_seen 6-near key Prior
slow_push() { key Prior && sleep 0.5; }
until_seen 7-at-target slow_push
key Return
seen 8-fired
shot fired
until_seen 9-out key Next Next
key e
shot asked
key Return
seen 10-feedback
shot feedback
for n in 1 2 3; do key Tab; shot "feedback-$n"; done
