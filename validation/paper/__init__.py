"""The paper of Peng et al. (2021): its pair, closed forms, evidence and a verdict on each claim."""
