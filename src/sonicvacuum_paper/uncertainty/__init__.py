"""What the paper leaves open, drawn together: how probable each statement is under each model of the ladder.

`inputs` lists what is drawn and how far it spreads, `batch` puts a card's chains with drawn numbers side by
side, one lane each, and reads them, `sample` does so for every case and model, `agreement` holds the
statements against the draws. `identify` maps which modulus, thickness and loss the printed numbers allow,
`decide` asks which experiment on this chain would tell the two lossy models apart, and `viscoelastic` whether
relaxation alone could make 15 GPa of the static moduli.
"""
